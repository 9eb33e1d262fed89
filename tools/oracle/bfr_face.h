#pragma once

#include "sample.h"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>

#include <vector>

using BfrFactory = OpenSubdiv::Bfr::RefinerSurfaceFactory<>;

// Without a cache, and approximating irregular points no earlier than at these levels.
OpenSubdiv::Bfr::SurfaceFactory::Options bfr_options(int smooth_level, int sharp_level);

// The limit surface of one face as OpenSubdiv's Bfr evaluates it.
// Never copied: copying a Bfr::Surface of 3.5.0 with more than 20 points frees its buffer twice.
class BfrFace {
public:
    // `positions` are those of the factory's mesh.
    BfrFace(const BfrFactory& factory, int face, const Vec3* positions);
    BfrFace(const BfrFace&) = delete;
    BfrFace& operator=(const BfrFace&) = delete;

    bool is_regular() const { return valid_ && surface_.IsRegular(); }
    // (u, v) of the quad around corner `sub` if the face is irregular.
    Sample evaluate(int sub, double u, double v) const;

private:
    OpenSubdiv::Bfr::Surface<double> surface_;
    std::vector<double> patch_points_;
    bool valid_ = false;
};
