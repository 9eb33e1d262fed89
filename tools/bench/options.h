#pragma once

#include "../osd/cage.h"

#include <string>

struct BenchOptions {
    std::string mesh;
    CageOptions cage;

    // Adaptive refinement.
    int isolation = 2;
    bool use_bspline_end_caps = false;
    bool single_crease = false;
    // No GL; and then limit stencils on a grid of this many cells, if any.
    bool cpu_only = false;
    int limit_rate = 0;

    // Tessellation.
    double tess = 8;
    // Edge length aimed at; 0: `tess` counts instead.
    double screen_space_pixels = 0;
    std::string spacing = "equal";
    bool cull = false;
    // Patches a draw call; 0: all, negative: as many as llvmpipe draws rightly.
    int chunk = -1;

    // Frames.
    int frame_count = 10, warmup_count = 2;
    int width = 1280, height = 720, sample_count = 0;
    std::string image;

    bool is_screen_space() const { return screen_space_pixels > 0; }
};

// Fails, or prints the manual and ends the program, where the command line says so.
BenchOptions parse_options(int argc, char** argv);
