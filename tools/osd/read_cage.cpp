#include "cage.h"

#include "../shared/fail.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

using namespace OpenSubdiv;

const char* const cage_options_manual =
    "  --scheme catmark|loop|bilinear   (default: by the file's name, loop_* and bilinear_*; else catmark)\n"
    "  --boundary none|edge|edgecorner  overrides the file's tag (without either: edgecorner)\n"
    "  --crease uniform|chaikin         overrides the file's tag\n"
    "  --smoothtri                      smooth triangle subdivision\n"
    "  --crease-pairs                   a crease tag of N vertices is N/2 edges (as OpenSubdiv's reader has it),\n"
    "                                   and not a polyline (the default)\n"
    "  --f64                            keep the file's coordinates in double; otherwise they are rounded to float\n"
    "                                   first, as renderers do\n";

bool CageOptions::take(Arguments& arguments) {
    if (arguments.is("--scheme"))
        scheme = arguments.value();
    else if (arguments.is("--boundary"))
        boundary = arguments.value();
    else if (arguments.is("--crease"))
        crease = arguments.value();
    else if (arguments.is("--smoothtri"))
        smooth_triangles = true;
    else if (arguments.is("--crease-pairs"))
        crease_pairs = true;
    else if (arguments.is("--f64"))
        keep_doubles = true;
    else
        return false;
    return true;
}

namespace {

// A line `t NAME ints/floats/strings ..`.
struct Tag {
    std::string name;
    std::vector<int> ints;
    std::vector<float> floats;
    std::vector<std::string> strings;

    // One for all, or one each, the last for those beyond; none: 0.
    float sharpness(size_t i) const {
        if (floats.empty())
            return 0;
        return std::max(0.0f, floats[std::min(i, floats.size() - 1)]);
    }
};

bool read_tag(std::istream& words, Tag& tag) {
    std::string counts;
    int int_count = 0, float_count = 0, string_count = 0;
    words >> tag.name >> counts;
    if (sscanf(counts.c_str(), "%d/%d/%d", &int_count, &float_count, &string_count) != 3)
        return false;
    tag.ints.resize(int_count);
    tag.floats.resize(float_count);
    tag.strings.resize(string_count);
    for (int& value : tag.ints)
        words >> value;
    for (float& value : tag.floats) {
        double number = 0;
        words >> number;
        value = (float)number;
    }
    for (std::string& value : tag.strings)
        words >> value;
    return true;
}

void add_creases(Cage& cage, const Tag& tag, bool pairs) {
    for (size_t i = 0; i + 1 < tag.ints.size(); i += pairs ? 2 : 1) {
        cage.crease_points.push_back(tag.ints[i]);
        cage.crease_points.push_back(tag.ints[i + 1]);
        cage.crease_sharpness.push_back(tag.sharpness(i));
    }
}

void add_corners(Cage& cage, const Tag& tag) {
    for (size_t i = 0; i < tag.ints.size(); ++i) {
        cage.corner_points.push_back(tag.ints[i]);
        cage.corner_sharpness.push_back(tag.sharpness(i));
    }
}

void apply_tag(Cage& cage, const Tag& tag, bool crease_pairs) {
    using Options = Sdc::Options;
    if (tag.name == "crease") {
        add_creases(cage, tag, crease_pairs);
    } else if (tag.name == "corner") {
        add_corners(cage, tag);
    } else if (tag.name == "hole") {
        cage.hole_faces.insert(cage.hole_faces.end(), tag.ints.begin(), tag.ints.end());
    } else if (tag.name == "interpolateboundary" && !tag.ints.empty()) {
        cage.options.SetVtxBoundaryInterpolation(tag.ints[0] == 0   ? Options::VTX_BOUNDARY_NONE
                                                 : tag.ints[0] == 1 ? Options::VTX_BOUNDARY_EDGE_AND_CORNER
                                                                    : Options::VTX_BOUNDARY_EDGE_ONLY);
    } else if (tag.name == "facevaryinginterpolateboundary" && !tag.ints.empty()) {
        if (tag.ints[0] < Options::FVAR_LINEAR_NONE || tag.ints[0] > Options::FVAR_LINEAR_ALL)
            fail("face-varying interpolation is 0 to 5");
        cage.options.SetFVarLinearInterpolation((Options::FVarLinearInterpolation)tag.ints[0]);
    } else if (tag.name == "creasemethod" && !tag.strings.empty()) {
        bool chaikin = tag.strings[0] == "chaikin";
        cage.options.SetCreasingMethod(chaikin ? Options::CREASE_CHAIKIN : Options::CREASE_UNIFORM);
    } else if (tag.name == "smoothtriangles") {
        bool smooth = tag.strings.empty() ? !tag.ints.empty() && tag.ints[0] : tag.strings[0] == "smooth";
        cage.options.SetTriangleSubdivision(smooth ? Options::TRI_SUB_SMOOTH : Options::TRI_SUB_CATMARK);
    }
}

void read_point(Cage& cage, std::istream& words, bool keep_doubles) {
    Vec3 point;
    words >> point.x >> point.y >> point.z;
    if (!keep_doubles)
        point = {(float)point.x, (float)point.y, (float)point.z};
    cage.points.push_back(point);
}

void read_value(Cage& cage, std::istream& words) {
    Vec3 value;
    words >> value.x >> value.y;
    cage.values.push_back({(float)value.x, (float)value.y, 0});
}

void read_face(Cage& cage, std::istream& words) {
    std::string corner;
    int size = 0;
    for (; words >> corner; ++size) {
        int index = atoi(corner.c_str());
        cage.face_points.push_back(index < 0 ? (int)cage.points.size() + index : index - 1);
        const size_t slash = corner.find('/');
        const int value = slash == std::string::npos ? 0 : atoi(corner.c_str() + slash + 1);
        if (value != 0)
            cage.face_values.push_back(value < 0 ? (int)cage.values.size() + value : value - 1);
    }
    cage.face_sizes.push_back(size);
}

void choose_scheme(Cage& cage, const std::string& path, const std::string& chosen) {
    std::string scheme = chosen;
    std::string file_name = path.substr(path.find_last_of('/') + 1);
    if (scheme.empty() && file_name.compare(0, 5, "loop_") == 0)
        scheme = "loop";
    if (scheme.empty() && file_name.compare(0, 9, "bilinear_") == 0)
        scheme = "bilinear";
    if (scheme == "loop")
        cage.scheme = Sdc::SCHEME_LOOP;
    else if (scheme == "bilinear")
        cage.scheme = Sdc::SCHEME_BILINEAR;
    else if (!scheme.empty() && scheme != "catmark")
        fail("unknown scheme " + scheme);
}

void override_tags(Cage& cage, const CageOptions& options) {
    if (options.boundary == "none")
        cage.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_NONE);
    else if (options.boundary == "edge")
        cage.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    else if (options.boundary == "edgecorner")
        cage.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    else if (!options.boundary.empty())
        fail("unknown boundary " + options.boundary);

    if (options.crease == "uniform")
        cage.options.SetCreasingMethod(Sdc::Options::CREASE_UNIFORM);
    else if (options.crease == "chaikin")
        cage.options.SetCreasingMethod(Sdc::Options::CREASE_CHAIKIN);
    else if (!options.crease.empty())
        fail("unknown crease method " + options.crease);

    if (options.smooth_triangles)
        cage.options.SetTriangleSubdivision(Sdc::Options::TRI_SUB_SMOOTH);
}

} // namespace

Cage read_cage(const std::string& path, const CageOptions& options) {
    std::ifstream in(path);
    if (!in)
        fail("cannot read " + path);
    Cage cage;
    cage.options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    cage.options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1);
    choose_scheme(cage, path, options.scheme);

    std::string line, key;
    while (std::getline(in, line)) {
        std::istringstream words(line);
        Tag tag;
        if (!(words >> key))
            continue;
        if (key == "v")
            read_point(cage, words, options.keep_doubles);
        else if (key == "vt")
            read_value(cage, words);
        else if (key == "f")
            read_face(cage, words);
        else if (key == "t" && read_tag(words, tag))
            apply_tag(cage, tag, options.crease_pairs);
    }
    override_tags(cage, options);
    for (int index : cage.face_points)
        if (index < 0 || index >= (int)cage.points.size())
            fail("a face refers to a vertex that is not there");
    if (cage.values.empty())
        cage.face_values.clear();
    if (!cage.face_values.empty() && cage.face_values.size() != cage.face_points.size())
        fail("some corners of faces have a vt, others have none");
    for (int index : cage.face_values)
        if (index < 0 || index >= (int)cage.values.size())
            fail("a face refers to a vt that is not there");
    return cage;
}
