#include "one_ring.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

using namespace OpenSubdiv;
using Index = Cage::Index;

namespace {

class OneRing {
public:
    OneRing(const Far::TopologyLevel& level, const Vec3* positions, const Cage& like)
        : level_(level), positions_(positions) {
        cage_.scheme = like.scheme;
        cage_.options = like.options;
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
        for (int i = 0; i < corners.size(); ++i) {
            if (level_.IsVertexNonManifold(corners[i])) {
                take_fan(face, corners[i]);
                continue;
            }
            Far::ConstIndexArray around = level_.GetVertexFaces(corners[i]);
            for (int k = 0; k < around.size(); ++k)
                take_face(around[k]);
        }
    }

    void take_face(Index face) {
        if (taken_.insert(face).second)
            faces_.push_back(face);
    }

    // The faces that are reached from `face` across manifold edges at the non-manifold `vertex`.
    void take_fan(Index face, Index vertex) {
        Far::ConstIndexArray edges = level_.GetVertexEdges(vertex);
        std::set<Index> fan{face};
        for (bool grown = true; grown;) {
            grown = false;
            for (int k = 0; k < edges.size(); ++k) {
                Far::ConstIndexArray beside = level_.GetEdgeFaces(edges[k]);
                if (level_.IsEdgeNonManifold(edges[k]) || beside.size() != 2 ||
                    fan.count(beside[0]) == fan.count(beside[1]))
                    continue;
                fan.insert(beside[0]);
                fan.insert(beside[1]);
                grown = true;
            }
        }
        for (Index fan_face : fan)
            take_face(fan_face);

        // The fan alone would not show that more than two infinitely sharp edges make the vertex a corner.
        int infinite_count = 0;
        for (int k = 0; k < edges.size(); ++k)
            infinite_count += level_.GetEdgeSharpness(edges[k]) >= infinite_sharpness;
        if (infinite_count > 2)
            forced_corners_.insert(vertex);
    }

    void add_face(Index face, int first_corner) {
        Far::ConstIndexArray corners = level_.GetFaceVertices(face);
        Far::ConstIndexArray edges = level_.GetFaceEdges(face);
        const int size = corners.size();
        const size_t first_point = cage_.face_points.size();
        cage_.face_sizes.push_back(size);
        for (int i = 0; i < size; ++i) {
            int point = point_of(corners[(i + first_corner) % size]);
            auto begin = cage_.face_points.begin() + first_point;
            if (std::find(begin, cage_.face_points.end(), point) != cage_.face_points.end())
                throw Pathological();
            cage_.face_points.push_back(point);
        }
        for (int i = 0; i < size; ++i) {
            int a = point_of(corners[i]), b = point_of(corners[(i + 1) % size]);
            auto known = edges_.emplace(std::minmax(a, b), edges[i]).first;
            if (known->second != edges[i])
                throw Pathological();
        }
    }

    int point_of(Index vertex) {
        auto [known, is_new] = points_.emplace(vertex, (int)cage_.points.size());
        if (!is_new)
            return known->second;
        cage_.points.push_back(positions_[vertex]);
        float sharpness = forced_corners_.count(vertex) ? infinite_sharpness : level_.GetVertexSharpness(vertex);
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
    std::set<Index> forced_corners_;
    std::unordered_map<Index, int> points_;
    // By their points in the cage, the edges of the level.
    std::map<std::pair<int, int>, Index> edges_;
};

} // namespace

Cage cut_out_one_ring(const Far::TopologyLevel& level, const Vec3* positions, Index face, int first_corner,
                      const Cage& like) {
    return OneRing(level, positions, like).cut_out(face, first_corner);
}
