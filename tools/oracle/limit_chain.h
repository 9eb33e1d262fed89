#pragma once

#include "bfr_face.h"

#include "../osd/cage.h"

#include <map>
#include <memory>
#include <vector>

enum class CornerKind {
    // Interior, not sharp at all, valence above 2, regular faces around it: its limit masks hold.
    smooth,
    // On a boundary, or infinitely sharp: its position and tangents are interpolated.
    sharp,
    // All else.
    odd,
};

// A face with its one-ring, in double precision, and the child faces that were asked for.
// Points are evaluated by following the child that holds them until it is one regular patch: so every value is that of
// a true B-spline or box spline piece of the limit surface, and no approximation at an irregular vertex is used.
class ChainNode {
public:
    // Of face 0 of a cage from `cut_out_one_ring`.
    explicit ChainNode(Cage&& ring) : ChainNode(std::move(ring), Vec3(), 0) {}

    // (u, v) of the face, or, where it is irregular, of the quad around its corner `sub`.
    Sample evaluate(int sub, double u, double v);

    bool is_regular_size() const { return size_ == ring_.regular_face_size(); }
    CornerKind corner_kind(int corner) const;
    // False where the face is certainly no regular patch: Bfr, which knows for sure, may crash there, and does not see
    // that semi-sharp edges of any fan at a non-manifold corner change its rule.
    bool may_be_regular() const;
    bool may_be_regular_at(Cage::Index corner) const;
    // Whether the face would be regular but for a corner.
    bool is_isolated(int corner) const;
    int sector_size(Cage::Index corner) const;
    // The quad around a corner of an irregular face.
    ChainNode& corner_quad(int corner);

private:
    ChainNode(Cage&& ring, Vec3 origin, int depth);

    void subdivide();
    // The child whose corners are these vertices of level 1, the first of them becoming its corner 0.
    ChainNode& child(int key, const std::vector<Cage::Index>& corners);
    // The vertices of level 1 at a corner, in the middle of the edge after it, and in the middle of the face.
    Cage::Index corner_vertex(int corner) const;
    Cage::Index edge_vertex(int corner) const;
    Cage::Index face_vertex() const;

    const BfrFace& bfr();
    Sample evaluate_bfr(double u, double v);
    // Of the quad's four corners, for a face so small that it is flat; Bfr may crash there.
    Sample evaluate_flat(double u, double v) const;
    Sample evaluate_smooth_corner(int corner);
    Sample evaluate_quad_child(double u, double v);
    Sample evaluate_triangle_child(double u, double v);

    // Positions are relative to `origin_`: tangents keep their digits while the ring shrinks.
    Cage ring_;
    Vec3 origin_;
    int depth_;
    int size_;
    std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner_;
    std::unique_ptr<BfrFace> bfr_;
    // Of level 1, once subdivided, and its limit, once asked for.
    std::vector<Vec3> child_points_, limit_points_, limit_tangents_u_, limit_tangents_v_;
    std::map<int, std::unique_ptr<ChainNode>> children_;
};
