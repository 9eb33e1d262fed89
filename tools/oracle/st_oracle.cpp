#include "st_oracle.h"

#include "one_ring.h"

#include "../shared/fail.h"

#include <opensubdiv/far/primvarRefiner.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace OpenSubdiv;
using Index = Cage::Index;

namespace {

// Halvings after which a face is flat.
constexpr int max_depth = 44;

bool is_semi_sharp(float sharpness) {
    return sharpness > 0 && sharpness < infinite_sharpness;
}

// After so many levels nothing of a cage is semi-sharp any more: sharpness falls by one a level, by Chaikin's rule to
// no more than that of the sharpest neighbour less one.
int decay_levels(const Cage& cage) {
    float sharpest = 0;
    for (const std::vector<float>* sharpness : {&cage.crease_sharpness, &cage.corner_sharpness})
        for (float s : *sharpness)
            sharpest = is_semi_sharp(s) ? std::max(sharpest, s) : sharpest;
    return (int)std::ceil(sharpest) + 1;
}

bool is_linear(const Cage& cage) {
    return cage.options.GetFVarLinearInterpolation() == Sdc::Options::FVAR_LINEAR_ALL;
}

// The value of a corner. OpenSubdiv may number one value twice where the faces around a vertex name several by turns;
// at non-manifold vertices, whose values all stay, that would look like a seam: there equal numbers are one value.
Index value_of_corner(const Far::TopologyLevel& level, const std::vector<Vec3>& values, Index face, int corner) {
    const Index value = level.GetFaceFVarValues(face, 0)[corner], vertex = level.GetFaceVertices(face)[corner];
    if (!level.IsVertexNonManifold(vertex))
        return value;
    for (Index other : level.GetVertexFaces(vertex)) {
        const Index known = level.GetFaceFVarValues(other, 0)[level.GetFaceVertices(other).FindIndex(vertex)];
        if (values[known].x == values[value].x && values[known].y == values[value].y)
            return known;
    }
    return value;
}

// Whether two faces at an edge have the same values at both its ends.
bool is_continuous(const Far::TopologyLevel& level, const std::vector<Vec3>& values, Index edge, Index a, Index b) {
    Far::ConstIndexArray ends = level.GetEdgeVertices(edge);
    auto value_at = [&](Index face, Index vertex) {
        return value_of_corner(level, values, face, level.GetFaceVertices(face).FindIndex(vertex));
    };
    return value_at(a, ends[0]) == value_at(b, ends[0]) && value_at(a, ends[1]) == value_at(b, ends[1]);
}

// The faces around a vertex that are reached from a face across edges that are neither infinitely sharp nor seams.
int sector_size(const Far::TopologyLevel& level, const std::vector<Vec3>& values, Index vertex, Index face,
                int& cut_count) {
    std::set<Index> sector{face};
    Far::ConstIndexArray edges = level.GetVertexEdges(vertex);
    auto is_cut = [&](Index edge) {
        Far::ConstIndexArray beside = level.GetEdgeFaces(edge);
        return level.GetEdgeSharpness(edge) >= infinite_sharpness || beside.size() != 2 ||
               !is_continuous(level, values, edge, beside[0], beside[1]);
    };
    cut_count = (int)std::count_if(edges.begin(), edges.end(), is_cut);
    for (bool grown = true; grown;) {
        grown = false;
        for (Index edge : edges) {
            Far::ConstIndexArray beside = level.GetEdgeFaces(edge);
            if (is_cut(edge) || sector.count(beside[0]) == sector.count(beside[1]))
                continue;
            sector.insert(beside.begin(), beside.end());
            grown = true;
        }
    }
    return (int)sector.size();
}

// Cuts a face of a level out with all faces around its corners, their sharpness and their values.
class ValueRing {
public:
    ValueRing(const Far::TopologyLevel& level, const std::vector<Vec3>& values, const Cage& like)
        : level_(level), values_(values) {
        cage_.scheme = like.scheme;
        cage_.options = like.options;
        // The level's sharpness says which vertices are corners; a fan of one face may be none.
        cage_.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    }

    Cage cut_out(Index face, int first_corner) {
        add_face(face, first_corner);
        std::set<Index> taken{face};
        for (Index corner : level_.GetFaceVertices(face))
            for (Index other : level_.GetVertexFaces(corner))
                if (taken.insert(other).second)
                    add_face(other, 0);
        add_sharpness();
        return std::move(cage_);
    }

private:
    void add_face(Index face, int first_corner) {
        Far::ConstIndexArray corners = level_.GetFaceVertices(face);
        Far::ConstIndexArray edges = level_.GetFaceEdges(face);
        const int size = corners.size();
        cage_.face_sizes.push_back(size);
        std::set<Index> met;
        for (int i = 0; i < size; ++i) {
            const int corner = (i + first_corner) % size;
            if (!met.insert(corners[corner]).second)
                throw Pathological();
            cage_.face_points.push_back(point_of(corners[corner]));
            cage_.face_values.push_back(value_of(value_of_corner(level_, values_, face, corner)));
        }
        for (int i = 0; i < size; ++i) {
            const int a = point_of(corners[i]), b = point_of(corners[(i + 1) % size]);
            if (edges_.emplace(std::minmax(a, b), edges[i]).first->second != edges[i])
                throw Pathological();
        }
    }

    int point_of(Index vertex) {
        auto [known, is_new] = points_.emplace(vertex, (int)cage_.points.size());
        if (is_new)
            cage_.points.push_back(Vec3());
        return known->second;
    }

    int value_of(Index value) {
        auto [known, is_new] = value_numbers_.emplace(value, (int)cage_.values.size());
        if (is_new)
            cage_.values.push_back(values_[value]);
        return known->second;
    }

    void add_sharpness() {
        for (const auto& [ends, edge] : edges_) {
            const float sharpness = level_.GetEdgeSharpness(edge);
            if (sharpness <= 0)
                continue;
            cage_.crease_points.insert(cage_.crease_points.end(), {ends.first, ends.second});
            cage_.crease_sharpness.push_back(sharpness);
        }
        for (const auto& [vertex, point] : points_) {
            const float sharpness = level_.GetVertexSharpness(vertex);
            if (sharpness <= 0)
                continue;
            cage_.corner_points.push_back(point);
            cage_.corner_sharpness.push_back(sharpness);
        }
    }

    const Far::TopologyLevel& level_;
    const std::vector<Vec3>& values_;
    Cage cage_;
    std::map<Index, int> points_, value_numbers_;
    std::map<std::pair<int, int>, Index> edges_;
};

} // namespace

// ---------------------------------------------------------------- refinement
RefinedValues::RefinedValues(Cage&& cage, bool has_rules_that_decay)
    : cage_(std::move(cage)), refiner_(make_refiner(cage_)) {
    if (!refiner_)
        fail("OpenSubdiv rejected the mesh, or a part of it");
    if (has_rules_that_decay) {
        Far::TopologyRefiner::AdaptiveOptions adaptive(decay_levels(cage_));
        adaptive.considerFVarChannels = true;
        adaptive.useInfSharpPatch = true;
        refiner_->RefineAdaptive(adaptive);
    } else {
        Far::TopologyRefiner::UniformOptions one_level(1);
        one_level.fullTopologyInLastLevel = true;
        refiner_->RefineUniform(one_level);
    }
    values_.push_back(cage_.values);
    Far::PrimvarRefinerReal<double> primvars(*refiner_);
    for (int k = 1; k <= refiner_->GetMaxLevel(); ++k) {
        std::vector<Vec3> finer(refiner_->GetLevel(k).GetNumFVarValues(0));
        const Vec3* source = values_.back().data();
        Vec3* destination = finer.data();
        primvars.InterpolateFaceVarying(k, source, destination, 0);
        values_.push_back(std::move(finer));
    }
}

bool RefinedValues::make_regular_surface(int face) {
    surface_.reset(new Bfr::Surface<double>());
    // The lowest levels there are: only regular patches are asked of it.
    BfrFactory factory(*refiner_, bfr_options(2, 2));
    if (!factory.InitFaceVaryingSurface(face, surface_.get(), 0) || !surface_->IsRegular())
        return false;
    patch_points_.resize(3 * surface_->GetNumPatchPoints());
    Bfr::Surface<double>::PointDescriptor three(3);
    surface_->PreparePatchPoints(&cage_.values[0].x, three, patch_points_.data(), three);
    return true;
}

Vec3 RefinedValues::evaluate_surface(double u, double v) const {
    const double uv[2] = {u, v};
    Vec3 value;
    surface_->Evaluate(uv, patch_points_.data(), Bfr::Surface<double>::PointDescriptor(3), &value.x);
    return value;
}

// ---------------------------------------------------------------- descent
ValueNode::ValueNode(std::shared_ptr<RefinedValues> refined, int level, int face, int first_corner, int depth)
    : refined_(std::move(refined)), level_(level), face_(face), first_corner_(first_corner), depth_(depth) {
    size_ = this->level().GetFaceVertices(face_).size();
}

Index ValueNode::vertex(int corner) const {
    return level().GetFaceVertices(face_)[(corner + first_corner_) % size_];
}

Index ValueNode::edge(int corner) const {
    return level().GetFaceEdges(face_)[(corner + first_corner_) % size_];
}

bool ValueNode::has_semi_sharp_corner() const {
    const Far::TopologyLevel here = level();
    for (int i = 0; i < size_; ++i)
        if (is_semi_sharp(here.GetVertexSharpness(vertex(i))) || has_semi_sharp_edge(here, vertex(i)))
            return true;
    return false;
}

// False where the face is certainly no regular patch of the channel: Bfr, which knows for sure, may crash there.
bool ValueNode::may_be_regular() const {
    const Far::TopologyLevel here = level();
    if (has_semi_sharp_corner())
        return false;
    for (int i = 0; i < 4; ++i) {
        const Index corner = vertex(i);
        if (here.IsVertexNonManifold(corner))
            return false;
        for (Index face : here.GetVertexFaces(corner))
            if (here.GetFaceVertices(face).size() != 4)
                return false;
        int cut_count = 0;
        const int size = sector_size(here, refined_->values(level_), corner, face_, cut_count);
        if (cut_count == 0 ? size != 4 || here.GetVertexSharpness(corner) > 0 : size > 2 || cut_count < 2)
            return false;
    }
    return true;
}

bool ValueNode::is_regular() {
    if (!is_examined_ && may_be_regular()) {
        cut_out();
        is_regular_ = refined_->make_regular_surface(0);
    }
    is_examined_ = true;
    return is_regular_;
}

bool ValueNode::has_children() const {
    if (level_ + 1 >= refined_->level_count())
        return false;
    const Far::TopologyLevel here = level();
    for (int i = 0; i < size_; ++i)
        if (here.GetVertexChildVertex(vertex(i)) < 0)
            return false;
    return here.GetFaceChildVertex(face_) >= 0;
}

void ValueNode::cut_out() {
    if (is_cut_)
        return;
    const Far::TopologyLevel here = level();
    Cage ring = ValueRing(here, refined_->values(level_), refined_->cage()).cut_out(face_, first_corner_);
    refined_ = std::make_shared<RefinedValues>(std::move(ring), has_semi_sharp_corner());
    level_ = face_ = first_corner_ = 0;
    is_cut_ = true;
}

ValueNode& ValueNode::child(int corner) {
    std::unique_ptr<ValueNode>& node = children_[corner];
    if (node)
        return *node;
    if (!has_children())
        cut_out();
    if (!has_children())
        fail("a one-ring was not refined");
    const Far::TopologyLevel here = level(), finer = refined_->level(level_ + 1);
    // The vertex, the middle of the edge after it, the middle of the face, the middle of the edge before it.
    const Index around[4] = {here.GetVertexChildVertex(vertex(corner)), here.GetEdgeChildVertex(edge(corner)),
                             here.GetFaceChildVertex(face_), here.GetEdgeChildVertex(edge(corner + size_ - 1))};
    // Quarters of a quad lie as the quad does; the quads of another face begin at its corners.
    const int turn = is_quad() ? corner : 0;
    for (Index face : here.GetFaceChildFaces(face_)) {
        if (face < 0)
            continue;
        Far::ConstIndexArray corners = finer.GetFaceVertices(face);
        for (int first = 0; first < 4; ++first) {
            bool is_same = true;
            for (int i = 0; i < 4; ++i)
                is_same &= corners[(first + i) % 4] == around[i];
            if (is_same) {
                node.reset(new ValueNode(refined_, level_ + 1, face, (first + 4 - turn) % 4, depth_ + 1));
                return *node;
            }
        }
    }
    fail("a child face is not where it should be");
}

Vec3 ValueNode::evaluate_flat(double u, double v) const {
    const double weights[4] = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
    Far::ConstIndexArray corners = level().GetFaceFVarValues(face_, 0);
    Vec3 value;
    for (int i = 0; i < 4; ++i)
        value.AddWithWeight(refined_->values(level_)[corners[(i + first_corner_) % 4]], weights[i]);
    return value;
}

Vec3 ValueNode::evaluate(int sub, double u, double v) {
    if (!is_quad())
        return child(sub).evaluate(0, u, v);
    if (is_linear(refined_->cage()) || depth_ >= max_depth)
        return evaluate_flat(u, v);
    if (is_regular())
        return refined_->evaluate_surface(u, v);
    const bool right = u > .5, upper = v > .5;
    const int corner = upper ? (right ? 2 : 3) : (right ? 1 : 0);
    return child(corner).evaluate(0, right ? 2 * u - 1 : 2 * u, upper ? 2 * v - 1 : 2 * v);
}

Vec3 ValueEvaluator::evaluate(int ptex, double u, double v) {
    const PtexFace& face = oracle_.ptex_face(ptex);
    if (face.base_face != base_face_) {
        root_.reset(new ValueNode(refined_, 0, face.base_face, 0, 0));
        base_face_ = face.base_face;
    }
    return root_->evaluate(face.corner, u, v);
}
