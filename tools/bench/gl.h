#pragma once

// GLEW must come before any other GL header, and OpenSubdiv's must know that it is there.
#include <GL/glew.h>
#define OSD_USES_GLEW

// A GL 4.5 core context without a window, current on this thread. Fails where there is none.
void make_gl_context();
