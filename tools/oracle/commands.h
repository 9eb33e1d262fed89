#pragma once

#include "limit_oracle.h"

#include <string>

// What the program can do with an oracle; each writes its result to standard output or to a file.

// How far is every vertex of a dump from the limit surface, and does the dump cover the parameter domain once?
void compare(const LimitOracle& oracle, const std::string& dump_path);
// How far are the s and t of every vertex of a dump from the limit of the cage's face-varying values?
void compare_st_alone(const LimitOracle& oracle, const std::string& dump_path);

// The oracle against limit masks after `depth` uniform subdivisions. Vertices that are still semi-sharp are skipped.
void selftest(const LimitOracle& oracle, int depth);

// Each corner of each ptex face against a point 2^-50 away from it on the face's diagonal: where there is a tangent
// plane, both ways must agree, so this says how good the values at exact corners are.
void compare_corners(const LimitOracle& oracle);

// Position and normal on the way towards a corner of a ptex face, from three directions.
void probe(const LimitOracle& oracle, int ptex, int corner);

struct GenerateOptions {
    int level = 4;
    // Grid cells along an edge; 0: 2^level.
    int rate = 0;
    int isolation = 6;
    bool ascii = false;
};
// A dump of limit masks after `level` uniform subdivisions; equal bits at a shared vertex, so watertight.
void generate_limit(const LimitOracle& oracle, const GenerateOptions& options, const std::string& path);
// A dump of OpenSubdiv's own patch table with Gregory end caps in float, each ptex face on its own grid: it cracks.
void generate_patch(const LimitOracle& oracle, const GenerateOptions& options, const std::string& path);
