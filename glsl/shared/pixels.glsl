// Pixels of images that were copied to buffers, row by row from the top.
#ifndef PLANISH_PIXELS
#define PLANISH_PIXELS
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Vec4s { vec4 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer HalfVec4s { uvec2 v[]; };
#endif
