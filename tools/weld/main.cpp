#include "weld.h"

#include "../shared/arguments.h"
#include "../shared/fail.h"
#include "../shared/json.h"

#include <cstdio>

static const char* const manual =
    "watertight: is a triangle dump closed, bit for bit?\n"
    "\n"
    "  watertight DUMP.ply [--positions-only] [--expect-boundary N]\n"
    "\n"
    "Vertices are welded by the exact bits of x y z (-0 counts as 0), and a second time by position and normal.\n"
    "A triangle with two equal welded corners is dropped. Then every undirected edge is counted. A closed base mesh\n"
    "has no open edge in the position weld if and only if there is no crack, T-junction or missing triangle at all.\n"
    "  --expect-boundary N  exit 1 unless the position weld has exactly N open edges, every edge used twice runs both\n"
    "                       ways, and no position is NaN or infinite; without it exit 0 once the file was read\n"
    "  --positions-only     no second weld; nx ny nz need not be there\n"
    "One line of JSON. `collapsed` counts triangles dropped for equal corners; `zero_area` those left whose corners\n"
    "lie on one line (area exactly 0 in double): they keep the mesh closed and are only reported.\n";

static const char* const usage = "usage: watertight DUMP.ply [--positions-only] [--expect-boundary N] (or --help)";

static std::string json_of(const WeldReport& report) {
    JsonObject json;
    json.count("welded_vertices", report.vertex_count)
        .count("triangles", report.triangle_count)
        .count("collapsed", report.collapsed_count)
        .count("zero_area", report.zero_area_count)
        .count("edges_once", report.edges_once)
        .count("edges_twice", report.edges_twice)
        .count("edges_over_twice", report.edges_over_twice)
        .count("twice_same_direction", report.twice_same_direction)
        .count("over_twice_unbalanced", report.over_twice_unbalanced)
        .boolean("winding_consistent", report.twice_same_direction == 0)
        .boolean("closed", report.edges_once == 0)
        .count("components", report.component_count)
        .count("boundary_components", report.boundary_component_count)
        .integer("euler", report.euler);
    std::string ends;
    for (const std::array<float, 3>& end : report.first_open_edge) {
        const double point[3] = {end[0], end[1], end[2]};
        ends += (ends.empty() ? "[" : ",") + json_array(point, 3, "%.9g");
    }
    if (!ends.empty())
        json.json("first_open_edge", ends + "]");
    return json.str();
}

int main(int argc, char** argv) {
    Arguments arguments(argc, argv);
    std::string path;
    bool positions_only = false;
    long expected_open = -1;
    while (arguments.next()) {
        if (arguments.is("--help"))
            print_manual(manual);
        else if (arguments.is("--positions-only"))
            positions_only = true;
        else if (arguments.is("--expect-boundary"))
            expected_open = arguments.integer();
        else if (path.empty() && !arguments.is_option())
            path = arguments.word();
        else
            fail(usage);
    }
    if (path.empty())
        fail(usage);

    Soup soup = read_soup(path);
    if (!positions_only && !soup.has_normals)
        fail("no normals in the file: use --positions-only");
    WeldReport by_position = weld(soup, WeldBy::position);
    JsonObject json;
    json.count("vertices", soup.vertices.size())
        .count("triangles", soup.triangles.size() / 3)
        .count("nonfinite", soup.nonfinite_count)
        .json("position", json_of(by_position));
    if (!positions_only)
        json.json("position_normal", json_of(weld(soup, WeldBy::position_and_normal)));

    bool pass = true;
    if (expected_open >= 0) {
        pass = (long)by_position.edges_once == expected_open && by_position.twice_same_direction == 0 &&
               soup.nonfinite_count == 0;
        json.integer("expected_open", expected_open).boolean("pass", pass);
    }
    printf("%s\n", json.str().c_str());
    return pass ? 0 : 1;
}
