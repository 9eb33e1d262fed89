#pragma once

#include "vec3.h"

#include "../shared/arguments.h"

#include <opensubdiv/far/topologyRefiner.h>

#include <memory>
#include <string>
#include <vector>

// A control mesh with its subdivision tags, as OpenSubdiv wants it.
struct Cage {
    using Index = OpenSubdiv::Far::Index;

    std::vector<Vec3> points;
    std::vector<int> face_sizes;
    // The points of all faces, one face after another.
    std::vector<int> face_points;
    // Two points an edge.
    std::vector<Index> crease_points;
    std::vector<float> crease_sharpness;
    std::vector<Index> corner_points;
    std::vector<float> corner_sharpness;
    std::vector<Index> hole_faces;
    // Face-varying values, s and t in x and y, and those of the corners of all faces, as `face_points`; or none.
    std::vector<Vec3> values;
    std::vector<Index> face_values;
    OpenSubdiv::Sdc::SchemeType scheme = OpenSubdiv::Sdc::SCHEME_CATMARK;
    OpenSubdiv::Sdc::Options options;

    bool is_loop() const { return scheme == OpenSubdiv::Sdc::SCHEME_LOOP; }
    // Corners of a regular face.
    int regular_face_size() const { return is_loop() ? 3 : 4; }
    int face_count() const { return (int)face_sizes.size(); }
};

// Sharpness from here on is infinite.
constexpr float infinite_sharpness = 10;

// What the command line says about a cage; an empty text leaves it to the file.
struct CageOptions {
    std::string scheme;   // catmark, loop, bilinear
    std::string boundary; // none, edge, edgecorner
    std::string crease;   // uniform, chaikin
    bool smooth_triangles = false;
    bool crease_pairs = false;
    bool keep_doubles = false;

    // Takes the current word, and its value, if it is an option about the cage.
    bool take(Arguments& arguments);
};

// Part of the manuals: what `take` knows.
extern const char* const cage_options_manual;

// Reads an OBJ file with OpenSubdiv's `t` tags. The scheme is Catmull-Clark, unless the file's name begins with loop_
// or bilinear_ or the options say so; without a tag or option, boundary edges are interpolated and corners are not, and
// face-varying values are linear at `corners plus 1`. Fails where a face names a vertex or a value that is not there,
// or where only some corners have a value.
Cage read_cage(const std::string& path, const CageOptions& options);

// Null where OpenSubdiv rejects the cage.
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> make_refiner(const Cage& cage);

// Of the points that faces use.
struct CageExtent {
    // Of their bounding box.
    double diagonal = 0;
    double max_coordinate = 0;
};
// Fails on a cage without extent.
CageExtent extent_of(const Cage& cage);

void report_opensubdiv_errors();
