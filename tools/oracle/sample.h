#pragma once

#include "../osd/vec3.h"

// Where exactly a point of the limit surface lies.
enum class PointKind {
    // In a face, on an edge, or on a corner where position and normal have limit masks that hold.
    ordinary,
    // On an irregular corner of a boundary, or of an infinitely sharp crease or corner: there need not be one normal.
    sharp_irregular,
    // On the end of one infinitely sharp edge, a valence 2 or a non-manifold vertex: the usual masks are inexact.
    odd,
};
constexpr int point_kind_count = 3;

// The limit surface at a point; `valid` is false where it has none.
struct Sample {
    bool valid = false;
    PointKind kind = PointKind::ordinary;
    Vec3 position;
    // Along u and v.
    Vec3 tangent_u, tangent_v;
    // The size of the piece that was evaluated, as a part of the base face: tangents are to be compared with it.
    double scale = 1;
};

// The unit normal; false where the tangents do not span a plane. `diagonal` is the size of the mesh.
bool normal_of(const Sample& sample, double diagonal, Vec3& normal);
