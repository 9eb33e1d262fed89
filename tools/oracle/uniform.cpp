#include "uniform.h"

#include "../shared/fail.h"

#include <opensubdiv/far/primvarRefiner.h>

using namespace OpenSubdiv;
using Index = Cage::Index;
using UV = std::array<double, 2>;

static UV middle(UV a, UV b) {
    return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
}

static std::vector<FaceDomain> base_domains(const LimitOracle& oracle) {
    const Cage& cage = oracle.cage();
    std::vector<FaceDomain> domains(cage.face_count());
    for (int face = 0; face < cage.face_count(); ++face) {
        if (cage.face_sizes[face] != cage.regular_face_size())
            continue;
        domains[face].ptex = oracle.first_ptex(face);
        if (cage.is_loop())
            domains[face].uv = {UV{0, 0}, UV{1, 0}, UV{0, 1}};
        else
            domains[face].uv = {UV{0, 0}, UV{1, 0}, UV{1, 1}, UV{0, 1}};
    }
    return domains;
}

namespace {

// Gives the children of one face their domains: the vertices of the next level are told apart by what they came from.
class ChildDomains {
public:
    ChildDomains(const LimitOracle& oracle, const Far::TopologyLevel& parents, const Far::TopologyLevel& children,
                 int parent)
        : oracle_(oracle), parents_(parents), children_(children), parent_(parent),
          corners_(parents.GetFaceVertices(parent)), edges_(parents.GetFaceEdges(parent)), size_(corners_.size()) {
        // Loop subdivision has no vertex in the middle of a face.
        face_vertex_ = oracle.cage().is_loop() ? -1 : parents.GetFaceChildVertex(parent);
    }

    void assign(const FaceDomain& parent_domain, std::vector<FaceDomain>& domains) const {
        Far::ConstIndexArray child_faces = parents_.GetFaceChildFaces(parent_);
        for (int k = 0; k < child_faces.size(); ++k) {
            Far::ConstIndexArray vertices = children_.GetFaceVertices(child_faces[k]);
            FaceDomain& domain = domains[child_faces[k]];
            if (size_ == oracle_.cage().regular_face_size()) {
                domain.ptex = parent_domain.ptex;
                for (int i = 0; i < vertices.size(); ++i)
                    domain.uv[i] = uv_in_regular_face(vertices[i], parent_domain);
            } else {
                const int corner = corner_of_child(vertices);
                domain.ptex = oracle_.first_ptex(parent_) + corner;
                for (int i = 0; i < vertices.size(); ++i)
                    domain.uv[i] = uv_in_corner_quad(vertices[i], corner);
            }
        }
    }

private:
    Index corner_vertex(int corner) const { return parents_.GetVertexChildVertex(corners_[corner]); }
    Index edge_vertex(int corner) const { return parents_.GetEdgeChildVertex(edges_[corner]); }

    UV uv_in_regular_face(Index vertex, const FaceDomain& parent) const {
        if (vertex == face_vertex_)
            return middle(parent.uv[0], parent.uv[2]);
        for (int i = 0; i < size_; ++i) {
            if (vertex == corner_vertex(i))
                return parent.uv[i];
            if (vertex == edge_vertex(i))
                return middle(parent.uv[i], parent.uv[(i + 1) % size_]);
        }
        fail("a corner of a child face comes from nothing in its parent");
    }

    UV uv_in_corner_quad(Index vertex, int corner) const {
        if (vertex == corner_vertex(corner))
            return {0, 0};
        if (vertex == edge_vertex(corner))
            return {1, 0};
        if (vertex == face_vertex_)
            return {1, 1};
        if (vertex == edge_vertex((corner + size_ - 1) % size_))
            return {0, 1};
        fail("a corner of a child face comes from nothing in its parent");
    }

    int corner_of_child(Far::ConstIndexArray vertices) const {
        for (int corner = 0; corner < size_; ++corner)
            if (vertices.FindIndex(corner_vertex(corner)) >= 0)
                return corner;
        fail("a child face has no corner of its parent");
    }

    const LimitOracle& oracle_;
    const Far::TopologyLevel& parents_;
    const Far::TopologyLevel& children_;
    int parent_;
    Far::ConstIndexArray corners_, edges_;
    int size_;
    Index face_vertex_;
};

} // namespace

UniformLimit::UniformLimit(const LimitOracle& oracle, int level) : level(level), refiner(make_refiner(oracle.cage())) {
    Far::TopologyRefiner::UniformOptions options(level);
    options.fullTopologyInLastLevel = true;
    refiner->RefineUniform(options);

    Far::PrimvarRefinerReal<double> primvars(*refiner);
    std::vector<Vec3> points = oracle.cage().points;
    domains = base_domains(oracle);
    for (int l = 1; l <= level; ++l) {
        const Far::TopologyLevel& parents = refiner->GetLevel(l - 1);
        const Far::TopologyLevel& children = refiner->GetLevel(l);
        std::vector<Vec3> child_points(children.GetNumVertices());
        const Vec3* source = points.data();
        Vec3* destination = child_points.data();
        primvars.Interpolate(l, source, destination);
        points.swap(child_points);

        std::vector<FaceDomain> child_domains(children.GetNumFaces());
        for (int face = 0; face < parents.GetNumFaces(); ++face)
            ChildDomains(oracle, parents, children, face).assign(domains[face], child_domains);
        domains.swap(child_domains);
    }

    positions.resize(points.size());
    tangents_u.resize(points.size());
    tangents_v.resize(points.size());
    const Vec3* source = points.data();
    Vec3 *limit = positions.data(), *u = tangents_u.data(), *v = tangents_v.data();
    primvars.Limit(source, limit, u, v);
}
