#pragma once

#include "../osd/cage.h"

#include <opensubdiv/far/topologyLevel.h>

// Thrown for what vertex indices cannot describe: a face that repeats a vertex, two edges between the same vertices.
struct Pathological {};

// Cuts a face of a refinement level out with all faces around its corners and their sharpness. The face becomes face 0
// of the new cage, its corner `first_corner` becomes corner 0. Around a non-manifold vertex only the face's own
// manifold fan is taken: the others meet it in infinitely sharp edges. Scheme and options are those of `like`.
Cage cut_out_one_ring(const OpenSubdiv::Far::TopologyLevel& level, const Vec3* positions, Cage::Index face,
                      int first_corner, const Cage& like);
