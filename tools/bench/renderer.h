#pragma once

#include "gl.h"
#include "image.h"
#include "options.h"
#include "tables.h"

#include <string>
#include <vector>

// Milliseconds of each measured frame, and what was drawn.
struct FrameReport {
    std::vector<double> refine_ms, draw_ms, total_ms;
    unsigned primitive_count = 0;
    // Pixels that are not the background.
    size_t covered_pixel_count = 0;
    std::string renderer;
};

// Draws the warm-up and the measured frames offscreen and writes the last one where an image is asked for.
FrameReport render_frames(const Cage& cage, const Tables& tables, const BenchOptions& options, Timings& timings);
