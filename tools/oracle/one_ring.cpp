#include "one_ring.h"

#include <algorithm>
#include <map>
#include <set>

using namespace OpenSubdiv;
using Index = Cage::Index;

namespace {

class OneRing {
public:
    OneRing(const Far::TopologyLevel& level, const Vec3* positions, const Cage& like)
        : level_(level), positions_(positions) {
        cage_.scheme = like.scheme;
        cage_.options = like.options;
        // The level's sharpness says which vertices are corners; a fan of one face may be none.
        cage_.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    }

    Cage cut_out(Index face, int first_corner) {
        collect_faces(face);
        for (Index ring_face : faces_)
            add_face(ring_face, ring_face == face ? first_corner : 0);
        add_creases();
        return std::move(cage_);
    }

private:
    void collect_faces(Index face) {
        take_face(face);
        Far::ConstIndexArray corners = level_.GetFaceVertices(face);
        for (Index corner : corners)
            if (level_.IsVertexNonManifold(corner))
                fans_[corner] = fan_of(face, corner);
        const bool are_settled = std::all_of(fans_.begin(), fans_.end(), [&](const auto& fan) {
            return is_settled_by(fan.second, fan.first);
        });
        if (!are_settled)
            fans_.clear();
        for (Index corner : corners) {
            const auto fan = fans_.find(corner);
            if (fan == fans_.end())
                take_around(corner);
            else
                std::for_each(fan->second.begin(), fan->second.end(), [&](Index fan_face) {
                    take_face(fan_face);
                });
        }
        if (is_chaikin())
            take_second_ring();
    }

    bool is_chaikin() const { return cage_.options.GetCreasingMethod() == Sdc::Options::CREASE_CHAIKIN; }

    // Whether the rule at a non-manifold vertex depends on no more than one of its fans.
    bool is_settled_by(const std::set<Index>& fan, Index vertex) const {
        const bool is_corner = level_.GetVertexSharpness(vertex) >= infinite_sharpness;
        if (has_semi_sharp_edge(level_, vertex) && (!is_corner || is_chaikin()))
            return false;
        if (is_corner || infinite_edge_count(vertex) > 2)
            return true;
        std::set<Index> fan_edges;
        for (Index fan_face : fan) {
            Far::ConstIndexArray around = level_.GetFaceEdges(fan_face);
            fan_edges.insert(around.begin(), around.end());
        }
        Far::ConstIndexArray edges = level_.GetVertexEdges(vertex);
        return std::all_of(edges.begin(), edges.end(), [&](Index edge) {
            return level_.GetEdgeSharpness(edge) < infinite_sharpness || fan_edges.count(edge);
        });
    }

    int infinite_edge_count(Index vertex) const {
        Far::ConstIndexArray edges = level_.GetVertexEdges(vertex);
        return (int)std::count_if(edges.begin(), edges.end(), [&](Index edge) {
            return level_.GetEdgeSharpness(edge) >= infinite_sharpness;
        });
    }

    // By Chaikin's rule the middle of an edge from a corner depends on the sharpness of all edges at the other end.
    void take_second_ring() {
        std::set<Index> vertices;
        for (Index ring_face : faces_) {
            Far::ConstIndexArray corners = level_.GetFaceVertices(ring_face);
            vertices.insert(corners.begin(), corners.end());
        }
        for (Index vertex : vertices)
            if (has_semi_sharp_edge(level_, vertex))
                take_around(vertex);
    }

    void take_around(Index vertex) {
        Far::ConstIndexArray around = level_.GetVertexFaces(vertex);
        for (int k = 0; k < around.size(); ++k)
            take_face(around[k]);
    }

    void take_face(Index face) {
        if (taken_.insert(face).second)
            faces_.push_back(face);
    }

    // The faces that are reached from `face` across manifold edges at the non-manifold `vertex`.
    std::set<Index> fan_of(Index face, Index vertex) const {
        std::set<Index> fan{face};
        for (bool grown = true; grown;) {
            grown = false;
            for (Index edge : level_.GetVertexEdges(vertex)) {
                Far::ConstIndexArray beside = level_.GetEdgeFaces(edge);
                if (level_.IsEdgeNonManifold(edge) || beside.size() != 2 ||
                    fan.count(beside[0]) == fan.count(beside[1]))
                    continue;
                fan.insert(beside.begin(), beside.end());
                grown = true;
            }
        }
        return fan;
    }

    void add_face(Index face, int first_corner) {
        Far::ConstIndexArray corners = level_.GetFaceVertices(face);
        Far::ConstIndexArray edges = level_.GetFaceEdges(face);
        const int size = corners.size();
        const size_t first_point = cage_.face_points.size();
        cage_.face_sizes.push_back(size);
        for (int i = 0; i < size; ++i) {
            int point = point_of(corners[(i + first_corner) % size], face);
            auto begin = cage_.face_points.begin() + first_point;
            if (std::find(begin, cage_.face_points.end(), point) != cage_.face_points.end())
                throw Pathological();
            cage_.face_points.push_back(point);
        }
        for (int i = 0; i < size; ++i) {
            int a = point_of(corners[i], face), b = point_of(corners[(i + 1) % size], face);
            auto known = edges_.emplace(std::minmax(a, b), edges[i]).first;
            if (known->second != edges[i])
                throw Pathological();
        }
    }

    // At a non-manifold corner, faces that were taken for other corners than this have a point of their own.
    int point_of(Index vertex, Index face) {
        const auto fan = fans_.find(vertex);
        const bool is_other_fan = fan != fans_.end() && !fan->second.count(face);
        auto [known, is_new] = points_.emplace(std::make_pair(vertex, is_other_fan), (int)cage_.points.size());
        if (!is_new)
            return known->second;
        cage_.points.push_back(positions_[vertex]);
        // A fan alone would not show that more than two infinitely sharp edges make the vertex a corner.
        const bool is_forced = fan != fans_.end() && infinite_edge_count(vertex) > 2;
        const float sharpness = is_forced ? infinite_sharpness : level_.GetVertexSharpness(vertex);
        if (sharpness > 0) {
            cage_.corner_points.push_back(known->second);
            cage_.corner_sharpness.push_back(sharpness);
        }
        return known->second;
    }

    void add_creases() {
        for (const auto& [ends, edge] : edges_) {
            float sharpness = level_.GetEdgeSharpness(edge);
            if (sharpness <= 0)
                continue;
            cage_.crease_points.push_back(ends.first);
            cage_.crease_points.push_back(ends.second);
            cage_.crease_sharpness.push_back(sharpness);
        }
    }

    const Far::TopologyLevel& level_;
    const Vec3* positions_;
    Cage cage_;
    std::vector<Index> faces_;
    std::set<Index> taken_;
    // Of the face's non-manifold corners, the faces that are taken, unless all are.
    std::map<Index, std::set<Index>> fans_;
    // Of each vertex, and of each corner in the faces of its other fans.
    std::map<std::pair<Index, bool>, int> points_;
    // By their points in the cage, the edges of the level.
    std::map<std::pair<int, int>, Index> edges_;
};

} // namespace

bool has_semi_sharp_edge(const Far::TopologyLevel& level, Index vertex) {
    Far::ConstIndexArray edges = level.GetVertexEdges(vertex);
    return std::any_of(edges.begin(), edges.end(), [&](Index edge) {
        const float sharpness = level.GetEdgeSharpness(edge);
        return sharpness > 0 && sharpness < infinite_sharpness;
    });
}

Cage cut_out_one_ring(const Far::TopologyLevel& level, const Vec3* positions, Index face, int first_corner,
                      const Cage& like) {
    return OneRing(level, positions, like).cut_out(face, first_corner);
}
