#include "commands.h"

#include "../shared/fail.h"

#include <algorithm>
#include <string>
#include <vector>

static const char* const manual =
    "osd_oracle: how far is a tessellation from the limit surface?\n"
    "\n"
    "  osd_oracle MESH.obj DUMP.ply [options]\n"
    "  osd_oracle --selftest MESH.obj [--level K] [options]\n"
    "  osd_oracle --corners MESH.obj [options]\n"
    "  osd_oracle --probe PTEX,CORNER MESH.obj [options]\n"
    "  osd_oracle --generate limit|patch MESH.obj OUT.ply [--level K | --rate N] [--isolation L] [--ascii] [options]\n"
    "\n"
    "Compares every vertex of a dump with OpenSubdiv's limit surface in double, at the vertex's face, u and v, and\n"
    "checks that the triangles of every face cover its parameter domain once. One line of JSON; see README.md.\n"
    "  --st        compares the face-varying s and t of the dump alone\n"
    "  --selftest  the oracle against limit masks after K uniform subdivisions\n"
    "  --corners   values at exact corners against points 2^-50 away\n"
    "  --probe     prints position and normal on the way to a corner\n"
    "  --generate  writes a dump: limit masks after K uniform subdivisions (watertight), or OpenSubdiv's patch table\n"
    "              with Gregory end caps in float, each ptex face on its own (it cracks)\n"
    "options:\n"
    "  -j N                             threads (2)\n"
    "  --bfr [--levels SMOOTH,SHARP]    OpenSubdiv's Bfr for every base face, at these levels (10,10), for "
    "comparison\n";

static const char* const usage = "usage: osd_oracle MESH.obj DUMP.ply [options] (or --help)";

namespace {

struct CommandLine {
    CageOptions cage;
    OracleOptions oracle;
    GenerateOptions generate;
    std::string generator;
    bool selftest = false, corners = false, st_alone = false;
    int probe_ptex = -1, probe_corner = 0;
    std::vector<std::string> files;

    bool needs_dump() const { return !selftest && !corners && probe_ptex < 0; }
};

bool take_command(Arguments& arguments, CommandLine& line) {
    if (arguments.is("--selftest"))
        line.selftest = true;
    else if (arguments.is("--corners"))
        line.corners = true;
    else if (arguments.is("--st"))
        line.st_alone = true;
    else if (arguments.is("--probe"))
        arguments.integer_pair(line.probe_ptex, line.probe_corner);
    else if (arguments.is("--generate"))
        line.generator = arguments.value();
    else if (arguments.is("--level"))
        line.generate.level = arguments.integer();
    else if (arguments.is("--rate"))
        line.generate.rate = arguments.integer();
    else if (arguments.is("--isolation"))
        line.generate.isolation = arguments.integer();
    else if (arguments.is("--ascii"))
        line.generate.ascii = true;
    else
        return false;
    return true;
}

bool take_oracle_option(Arguments& arguments, OracleOptions& options) {
    if (arguments.is("--bfr"))
        options.use_bfr = true;
    else if (arguments.is("--levels"))
        arguments.integer_pair(options.smooth_level, options.sharp_level);
    else if (arguments.is("-j"))
        options.thread_count = std::max(1, arguments.integer());
    else
        return false;
    return true;
}

CommandLine parse(Arguments& arguments) {
    CommandLine line;
    while (arguments.next()) {
        if (arguments.is("--help"))
            print_manual((std::string(manual) + cage_options_manual).c_str());
        if (take_command(arguments, line) || take_oracle_option(arguments, line.oracle) || line.cage.take(arguments))
            continue;
        if (arguments.is_option())
            fail("unknown option " + arguments.word());
        line.files.push_back(arguments.word());
    }
    const auto [low, high] = std::minmax(line.oracle.smooth_level, line.oracle.sharp_level);
    if (low < 2 || high > 10)
        fail("--levels are 2 to 10");
    if (line.files.size() != (line.needs_dump() ? 2u : 1u))
        fail(usage);
    return line;
}

} // namespace

int main(int argc, char** argv) {
    Arguments arguments(argc, argv);
    const CommandLine line = parse(arguments);
    report_opensubdiv_errors();
    const Cage cage = read_cage(line.files[0], line.cage);
    const LimitOracle oracle(cage, line.oracle);
    if (line.selftest)
        selftest(oracle, line.generate.level);
    else if (line.corners)
        compare_corners(oracle);
    else if (line.probe_ptex >= oracle.ptex_count())
        fail("--probe: there is no such ptex face");
    else if (line.probe_ptex >= 0)
        probe(oracle, line.probe_ptex, line.probe_corner);
    else if (line.generator == "limit")
        generate_limit(oracle, line.generate, line.files[1]);
    else if (line.generator == "patch")
        generate_patch(oracle, line.generate, line.files[1]);
    else if (!line.generator.empty())
        fail("--generate limit|patch");
    else if (line.st_alone)
        compare_st_alone(oracle, line.files[1]);
    else
        compare(oracle, line.files[1]);
    return 0;
}
