#pragma once

#include "../osd/cage.h"

#include <opensubdiv/far/topologyLevel.h>

// Thrown for what vertex indices cannot describe: a face that repeats a vertex, two edges between the same vertices.
struct Pathological {};

// Cuts a face of a refinement level out with all faces around its corners and their sharpness. The face becomes face 0
// of the new cage, its corner `first_corner` becomes corner 0. Around a non-manifold vertex only the face's own
// manifold fan is taken where the others, which meet it in infinitely sharp edges, do not change the vertex's rule.
// With Chaikin's rule, the faces around semi-sharp vertices of the one-ring are taken too. Scheme and options are those
// of `like`, but for the boundary's: corners are sharp vertices.
Cage cut_out_one_ring(const OpenSubdiv::Far::TopologyLevel& level, const Vec3* positions, Cage::Index face,
                      int first_corner, const Cage& like);

bool has_semi_sharp_edge(const OpenSubdiv::Far::TopologyLevel& level, Cage::Index vertex);
