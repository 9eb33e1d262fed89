#include "weld.h"

#include "../shared/fail.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace {

class DisjointSets {
public:
    explicit DisjointSets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

    uint32_t find(uint32_t element) {
        while (parent_[element] != element)
            element = parent_[element] = parent_[parent_[element]];
        return element;
    }
    void join(uint32_t a, uint32_t b) { parent_[find(a)] = find(b); }
    bool is_root(uint32_t element) { return find(element) == element; }

private:
    std::vector<uint32_t> parent_;
};

// A directed edge between welded vertices, packed so that both directions of an edge sort side by side:
//   bits 63..32 lower vertex | 31..1 higher vertex | 0 runs from the higher to the lower
class PackedEdge {
public:
    PackedEdge(uint32_t from, uint32_t to)
        : bits_((uint64_t)std::min(from, to) << 32 | (uint64_t)std::max(from, to) << 1 | (from < to ? 0 : 1)) {}

    uint32_t low() const { return (uint32_t)(bits_ >> 32); }
    uint32_t high() const { return (uint32_t)(bits_ >> 1) & 0x7fffffff; }
    bool is_forward() const { return !(bits_ & 1); }
    bool same_edge(PackedEdge other) const { return bits_ >> 1 == other.bits_ >> 1; }
    bool operator<(PackedEdge other) const { return bits_ < other.bits_; }

private:
    uint64_t bits_;
};
constexpr size_t max_welded_count = 1u << 31;

struct WeldedVertices {
    // Of each vertex of the soup, its welded vertex.
    std::vector<uint32_t> welded_index;
    // Of each welded vertex, one in the soup.
    std::vector<uint32_t> representative;
};

WeldedVertices weld_vertices(const std::vector<VertexBits>& vertices, WeldBy by) {
    const size_t bytes = (size_t)by * sizeof(uint32_t);
    auto compare = [&](uint32_t a, uint32_t b) {
        return memcmp(vertices[a].data(), vertices[b].data(), bytes);
    };
    std::vector<uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        int sign = compare(a, b);
        return sign ? sign < 0 : a < b;
    });

    WeldedVertices welded;
    welded.welded_index.resize(vertices.size());
    for (size_t k = 0; k < order.size(); ++k) {
        if (k == 0 || compare(order[k], order[k - 1]))
            welded.representative.push_back(order[k]);
        welded.welded_index[order[k]] = (uint32_t)welded.representative.size() - 1;
    }
    if (welded.representative.size() >= max_welded_count)
        fail("too many vertices");
    return welded;
}

class Welder {
public:
    Welder(const Soup& soup, WeldBy by)
        : soup_(soup), vertices_(weld_vertices(soup.vertices, by)), welded_count_(vertices_.representative.size()),
          used_(welded_count_), on_boundary_(welded_count_), components_(welded_count_), boundaries_(welded_count_) {}

    WeldReport run() {
        for (size_t i = 0; i < soup_.triangles.size(); i += 3)
            add_triangle(&soup_.triangles[i]);
        std::sort(edges_.begin(), edges_.end());
        size_t edge_count = 0;
        for (size_t first = 0, last; first < edges_.size(); first = last, ++edge_count) {
            last = first;
            while (last < edges_.size() && edges_[last].same_edge(edges_[first]))
                ++last;
            add_edge(first, last);
        }
        count_vertices();
        report_.euler = (long)report_.vertex_count - (long)edge_count + (long)report_.triangle_count;
        return report_;
    }

private:
    std::array<float, 3> position(uint32_t welded) const {
        std::array<float, 3> point;
        memcpy(point.data(), soup_.vertices[vertices_.representative[welded]].data(), sizeof point);
        return point;
    }

    bool has_zero_area(uint32_t a, uint32_t b, uint32_t c) const {
        std::array<float, 3> corner = position(a), second = position(b), third = position(c);
        double u[3], v[3];
        for (int k = 0; k < 3; ++k) {
            u[k] = (double)second[k] - corner[k];
            v[k] = (double)third[k] - corner[k];
        }
        return u[1] * v[2] - u[2] * v[1] == 0 && u[2] * v[0] - u[0] * v[2] == 0 && u[0] * v[1] - u[1] * v[0] == 0;
    }

    void add_triangle(const uint32_t* corners) {
        uint32_t a = vertices_.welded_index[corners[0]];
        uint32_t b = vertices_.welded_index[corners[1]];
        uint32_t c = vertices_.welded_index[corners[2]];
        if (a == b || b == c || c == a) {
            ++report_.collapsed_count;
            return;
        }
        ++report_.triangle_count;
        report_.zero_area_count += has_zero_area(a, b, c);
        used_[a] = used_[b] = used_[c] = true;
        edges_.emplace_back(a, b);
        edges_.emplace_back(b, c);
        edges_.emplace_back(c, a);
        components_.join(a, b);
        components_.join(b, c);
    }

    // One undirected edge: the packed edges from `first` up to `last`.
    void add_edge(size_t first, size_t last) {
        size_t count = last - first, forward_count = 0;
        for (size_t i = first; i < last; ++i)
            forward_count += edges_[i].is_forward();
        if (count == 1) {
            add_open_edge(edges_[first].low(), edges_[first].high());
        } else if (count == 2) {
            ++report_.edges_twice;
            report_.twice_same_direction += forward_count != 1;
        } else {
            ++report_.edges_over_twice;
            report_.over_twice_unbalanced += 2 * forward_count != count;
        }
    }

    void add_open_edge(uint32_t low, uint32_t high) {
        ++report_.edges_once;
        on_boundary_[low] = on_boundary_[high] = true;
        boundaries_.join(low, high);
        if (report_.first_open_edge.empty())
            report_.first_open_edge = {position(low), position(high)};
    }

    void count_vertices() {
        for (uint32_t i = 0; i < welded_count_; ++i) {
            report_.vertex_count += used_[i];
            report_.component_count += used_[i] && components_.is_root(i);
            report_.boundary_component_count += on_boundary_[i] && boundaries_.is_root(i);
        }
    }

    const Soup& soup_;
    WeldedVertices vertices_;
    size_t welded_count_;
    std::vector<bool> used_, on_boundary_;
    DisjointSets components_, boundaries_;
    std::vector<PackedEdge> edges_;
    WeldReport report_;
};

} // namespace

WeldReport weld(const Soup& soup, WeldBy by) {
    return Welder(soup, by).run();
}
