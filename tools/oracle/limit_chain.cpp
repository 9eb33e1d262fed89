#include "limit_chain.h"

#include "one_ring.h"

#include "../shared/fail.h"

#include <opensubdiv/far/primvarRefiner.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace OpenSubdiv;
using Index = Cage::Index;

// Halvings after which a point counts as the corner that it approaches; a double has 53 bits.
constexpr int max_depth = 100;
// Bfr is only asked for irregular faces from here on: where faces have several vertices in common, it may crash.
constexpr int min_sharp_depth = 3;

ChainNode::ChainNode(Cage&& ring, Vec3 origin, int depth) : ring_(std::move(ring)), origin_(origin), depth_(depth) {
    size_ = ring_.face_sizes[0];
    const Vec3 center = ring_.points[ring_.face_points[0]];
    for (Vec3& point : ring_.points)
        point = point - center;
    origin_.AddWithWeight(center, 1);
    refiner_ = make_refiner(ring_);
    if (!refiner_)
        fail("OpenSubdiv rejected a one-ring");
}

// ---------------------------------------------------------------- subdivision
void ChainNode::subdivide() {
    if (!child_points_.empty())
        return;
    Far::TopologyRefiner::UniformOptions one_level(1);
    one_level.fullTopologyInLastLevel = true;
    refiner_->RefineUniform(one_level);
    child_points_.resize(refiner_->GetLevel(1).GetNumVertices());
    const Vec3* source = ring_.points.data();
    Vec3* destination = child_points_.data();
    Far::PrimvarRefinerReal<double>(*refiner_).Interpolate(1, source, destination);
}

Index ChainNode::corner_vertex(int corner) const {
    const Far::TopologyLevel& level = refiner_->GetLevel(0);
    return level.GetVertexChildVertex(level.GetFaceVertices(0)[corner]);
}

Index ChainNode::edge_vertex(int corner) const {
    const Far::TopologyLevel& level = refiner_->GetLevel(0);
    return level.GetEdgeChildVertex(level.GetFaceEdges(0)[corner]);
}

Index ChainNode::face_vertex() const {
    return refiner_->GetLevel(0).GetFaceChildVertex(0);
}

// Where `corners` begins in the face, or -1 where they are not its corners in order.
static int rotation_of(Far::ConstIndexArray face, const std::vector<Index>& corners) {
    const int size = face.size();
    for (int first = 0; size == (int)corners.size() && first < size; ++first) {
        int i = 0;
        while (i < size && face[(i + first) % size] == corners[i])
            ++i;
        if (i == size)
            return first;
    }
    return -1;
}

ChainNode& ChainNode::child(int key, const std::vector<Index>& corners) {
    std::unique_ptr<ChainNode>& node = children_[key];
    if (node)
        return *node;
    const Far::TopologyLevel& level = refiner_->GetLevel(1);
    Far::ConstIndexArray child_faces = refiner_->GetLevel(0).GetFaceChildFaces(0);
    for (int k = 0; k < child_faces.size(); ++k) {
        int first = rotation_of(level.GetFaceVertices(child_faces[k]), corners);
        if (first < 0)
            continue;
        Cage ring = cut_out_one_ring(level, child_points_.data(), child_faces[k], first, ring_);
        node.reset(new ChainNode(std::move(ring), origin_, depth_ + 1));
        return *node;
    }
    fail("a child face is not where it should be");
}

ChainNode& ChainNode::corner_quad(int corner) {
    subdivide();
    int previous = (corner + size_ - 1) % size_;
    return child(corner, {corner_vertex(corner), edge_vertex(corner), face_vertex(), edge_vertex(previous)});
}

// ---------------------------------------------------------------- corners
CornerKind ChainNode::corner_kind(int corner) const {
    const Far::TopologyLevel& level = refiner_->GetLevel(0);
    const Index vertex = level.GetFaceVertices(0)[corner];
    const float vertex_sharpness = level.GetVertexSharpness(vertex);
    const bool is_semi_sharp = vertex_sharpness > 0 && vertex_sharpness < infinite_sharpness;
    if (level.IsVertexNonManifold(vertex) || is_semi_sharp)
        return CornerKind::odd;

    int infinite_count = 0, boundary_count = 0;
    Far::ConstIndexArray edges = level.GetVertexEdges(vertex);
    for (int k = 0; k < edges.size(); ++k) {
        const float sharpness = level.GetEdgeSharpness(edges[k]);
        const bool is_boundary = level.IsEdgeBoundary(edges[k]);
        boundary_count += is_boundary;
        if (is_boundary || sharpness >= infinite_sharpness)
            ++infinite_count;
        else if (sharpness > 0)
            return CornerKind::odd;
    }
    Far::ConstIndexArray faces = level.GetVertexFaces(vertex);
    for (int k = 0; k < faces.size(); ++k)
        if (level.GetFaceVertices(faces[k]).size() != ring_.regular_face_size())
            return CornerKind::odd;
    if (boundary_count == 0 && faces.size() < 3)
        return CornerKind::odd;
    if (vertex_sharpness >= infinite_sharpness || infinite_count >= 2)
        return CornerKind::sharp;
    return infinite_count == 0 ? CornerKind::smooth : CornerKind::odd;
}

// The faces of the sector at a corner of face 0, between infinitely sharp edges or all around.
int ChainNode::sector_size(Index corner) const {
    const Far::TopologyLevel& level = refiner_->GetLevel(0);
    Far::ConstIndexArray edges = level.GetVertexEdges(corner);
    std::set<Index> sector{0};
    for (bool grown = true; grown;) {
        grown = false;
        for (Index edge : edges) {
            Far::ConstIndexArray beside = level.GetEdgeFaces(edge);
            if (level.GetEdgeSharpness(edge) >= infinite_sharpness || beside.size() != 2 ||
                sector.count(beside[0]) == sector.count(beside[1]))
                continue;
            sector.insert(beside.begin(), beside.end());
            grown = true;
        }
    }
    return (int)sector.size();
}

bool ChainNode::may_be_regular_at(Index corner) const {
    const Far::TopologyLevel& level = refiner_->GetLevel(0);
    if (level.IsVertexNonManifold(corner) || has_semi_sharp_edge(level, corner))
        return false;
    for (Index face : level.GetVertexFaces(corner))
        if (level.GetFaceVertices(face).size() != 4)
            return false;
    int infinite_count = 0;
    for (Index edge : level.GetVertexEdges(corner))
        infinite_count += level.GetEdgeSharpness(edge) >= infinite_sharpness;
    const bool is_corner = level.GetVertexSharpness(corner) > 0 || infinite_count > 2;
    return sector_size(corner) == (is_corner ? 1 : infinite_count == 2 ? 2 : 4);
}

bool ChainNode::may_be_regular() const {
    Far::ConstIndexArray corners = refiner_->GetLevel(0).GetFaceVertices(0);
    return ring_.is_loop() || std::all_of(corners.begin(), corners.end(), [&](Index corner) {
               return may_be_regular_at(corner);
           });
}

bool ChainNode::is_isolated(int corner) const {
    Far::ConstIndexArray corners = refiner_->GetLevel(0).GetFaceVertices(0);
    for (int i = 0; i < corners.size(); ++i)
        if (i != corner && !ring_.is_loop() && !may_be_regular_at(corners[i]))
            return false;
    return true;
}

// The corner that (u, v) is exactly on, or -1.
static int corner_at(double u, double v, bool is_triangle) {
    if (u == 0 && v == 0)
        return 0;
    if (u == 1 && v == 0)
        return 1;
    if (u == 1 && v == 1 && !is_triangle)
        return 2;
    if (u == 0 && v == 1)
        return is_triangle ? 2 : 3;
    return -1;
}

Sample ChainNode::evaluate_smooth_corner(int corner) {
    subdivide();
    if (limit_points_.empty()) {
        limit_points_.resize(child_points_.size());
        limit_tangents_u_.resize(child_points_.size());
        limit_tangents_v_.resize(child_points_.size());
        const Vec3* source = child_points_.data();
        Vec3* points = limit_points_.data();
        Vec3* tangents_u = limit_tangents_u_.data();
        Vec3* tangents_v = limit_tangents_v_.data();
        Far::PrimvarRefinerReal<double>(*refiner_).Limit(source, points, tangents_u, tangents_v);
    }
    const Index vertex = corner_vertex(corner);
    Sample sample;
    sample.valid = true;
    sample.position = limit_points_[vertex];
    sample.position.AddWithWeight(origin_, 1);
    sample.tangent_u = limit_tangents_u_[vertex];
    sample.tangent_v = limit_tangents_v_[vertex];
    sample.scale = std::ldexp(1.0, -depth_);
    return sample;
}

// ---------------------------------------------------------------- evaluation
const BfrFace& ChainNode::bfr() {
    if (!bfr_) {
        // The lowest levels there are: only regular patches and interpolated corners are asked of it.
        BfrFactory factory(*refiner_, bfr_options(2, 2));
        bfr_.reset(new BfrFace(factory, 0, ring_.points.data()));
    }
    return *bfr_;
}

Sample ChainNode::evaluate_bfr(double u, double v) {
    Sample sample = bfr().evaluate(0, u, v);
    sample.position.AddWithWeight(origin_, 1);
    sample.scale = std::ldexp(1.0, -depth_);
    return sample;
}

Sample ChainNode::evaluate_flat(double u, double v) const {
    const Index* corners = ring_.face_points.data();
    const double weights[4] = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
    const double weights_u[4] = {v - 1, 1 - v, v, -v}, weights_v[4] = {u - 1, -u, u, 1 - u};
    Sample sample;
    sample.valid = true;
    sample.position = origin_;
    sample.scale = std::ldexp(1.0, -depth_);
    for (int i = 0; i < 4; ++i) {
        sample.position.AddWithWeight(ring_.points[corners[i]], weights[i]);
        sample.tangent_u.AddWithWeight(ring_.points[corners[i]], weights_u[i]);
        sample.tangent_v.AddWithWeight(ring_.points[corners[i]], weights_v[i]);
    }
    return sample;
}

Sample ChainNode::evaluate(int sub, double u, double v) {
    if (!is_regular_size())
        return corner_quad(sub).evaluate(0, u, v);
    if (ring_.scheme == Sdc::SCHEME_BILINEAR || (may_be_regular() && bfr().is_regular()))
        return evaluate_bfr(u, v);

    const int corner = corner_at(u, v, ring_.is_loop());
    const CornerKind kind = corner < 0 ? CornerKind::odd : corner_kind(corner);
    if (kind == CornerKind::smooth)
        return evaluate_smooth_corner(corner);
    if (kind == CornerKind::sharp && depth_ >= min_sharp_depth && is_isolated(corner)) {
        Sample sample = evaluate_bfr(u, v);
        sample.kind = PointKind::sharp_irregular;
        return sample;
    }
    if (depth_ >= max_depth) {
        Sample sample = ring_.is_loop() ? evaluate_bfr(u, v) : evaluate_flat(u, v);
        sample.kind = corner < 0 ? PointKind::ordinary : PointKind::odd;
        return sample;
    }
    subdivide();
    return ring_.is_loop() ? evaluate_triangle_child(u, v) : evaluate_quad_child(u, v);
}

Sample ChainNode::evaluate_quad_child(double u, double v) {
    const bool right = u > .5, upper = v > .5;
    const double child_u = right ? 2 * u - 1 : 2 * u, child_v = upper ? 2 * v - 1 : 2 * v;
    const Index center = face_vertex();
    if (!right && !upper)
        return child(0, {corner_vertex(0), edge_vertex(0), center, edge_vertex(3)}).evaluate(0, child_u, child_v);
    if (right && !upper)
        return child(1, {edge_vertex(0), corner_vertex(1), edge_vertex(1), center}).evaluate(0, child_u, child_v);
    if (right && upper)
        return child(2, {center, edge_vertex(1), corner_vertex(2), edge_vertex(2)}).evaluate(0, child_u, child_v);
    return child(3, {edge_vertex(3), center, edge_vertex(2), corner_vertex(3)}).evaluate(0, child_u, child_v);
}

Sample ChainNode::evaluate_triangle_child(double u, double v) {
    const double weights[3] = {1 - u - v, u, v};
    for (int i = 0; i < 3; ++i) {
        if (weights[i] < .5)
            continue;
        const int next = (i + 1) % 3, last = (i + 2) % 3;
        ChainNode& node = child(i, {corner_vertex(i), edge_vertex(i), edge_vertex(last)});
        return node.evaluate(0, 2 * weights[next], 2 * weights[last]);
    }
    // The middle one: its corners are the middles of the edges, the i-th opposite to corner i + 2.
    ChainNode& node = child(3, {edge_vertex(0), edge_vertex(1), edge_vertex(2)});
    return node.evaluate(0, 1 - 2 * weights[0], 1 - 2 * weights[1]);
}
