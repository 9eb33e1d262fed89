#pragma once

#include "gl.h"
#include "options.h"

#include <opensubdiv/far/patchDescriptor.h>

// OpenSubdiv's shaders for one type of patch with a Lambert fragment shader.
// Uniforms: MV, PROJ; TESS, which is OsdTessLevel(); PRIMBASE, the first patch of a draw.
GLuint make_patch_program(const BenchOptions& options, OpenSubdiv::Far::PatchDescriptor::Type type);
