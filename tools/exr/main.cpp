#include "attributes.h"
#include "samples.h"

#include "../shared/arguments.h"
#include "../shared/fail.h"

#include <ImfMultiPartInputFile.h>

#include <cstdio>
#include <exception>

static const char* const manual =
    "exr_dump: what OpenEXR's own library reads in a file\n"
    "\n"
    "  exr_dump FILE.exr     prints parts, attributes and channels\n"
    "  exr_dump FILE.exr --part N --channel NAME -o OUT\n"
    "                        writes a channel's samples instead, row by row, as they are stored, little-endian; parts\n"
    "                        count from 0, which is also the default\n"
    "One line of JSON. Strings are printed byte for byte, matrices row by row; a value of another type is null.\n";

static const char* const usage = "usage: exr_dump FILE.exr [--part N --channel NAME -o OUT] (or --help)";

static void run(const std::string& path, int part, const std::string& channel, const std::string& out) {
    Imf::MultiPartInputFile file(path.c_str());
    if (channel.empty()) {
        puts(json_of(file).c_str());
        return;
    }
    if (part < 0 || part >= file.parts())
        fail("there is no part " + std::to_string(part) + " in " + path);
    write_channel(file, part, channel, out);
}

int main(int argc, char** argv) {
    Arguments arguments(argc, argv);
    std::string path, channel, out;
    int part = 0;
    while (arguments.next()) {
        if (arguments.is("--help"))
            print_manual(manual);
        else if (arguments.is("--part"))
            part = arguments.integer();
        else if (arguments.is("--channel"))
            channel = arguments.value();
        else if (arguments.is("-o"))
            out = arguments.value();
        else if (path.empty() && !arguments.is_option())
            path = arguments.word();
        else
            fail(usage);
    }
    if (path.empty() || channel.empty() != out.empty())
        fail(usage);
    try {
        run(path, part, channel, out);
    } catch (const std::exception& error) {
        fail(error.what());
    }
}
