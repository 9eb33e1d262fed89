#include "bfr_face.h"

#include <opensubdiv/bfr/parameterization.h>

#include <algorithm>

using namespace OpenSubdiv;

Bfr::SurfaceFactory::Options bfr_options(int smooth_level, int sharp_level) {
    Bfr::SurfaceFactory::Options options;
    options.EnableCaching(false);
    options.SetApproxLevelSmooth(smooth_level);
    options.SetApproxLevelSharp(std::max(smooth_level, sharp_level));
    return options;
}

BfrFace::BfrFace(const BfrFactory& factory, int face, const Vec3* positions) {
    valid_ = factory.InitVertexSurface(face, &surface_) && surface_.IsValid();
    if (!valid_)
        return;
    patch_points_.resize(3 * surface_.GetNumPatchPoints());
    Bfr::Surface<double>::PointDescriptor xyz(3);
    surface_.PreparePatchPoints(&positions[0].x, xyz, patch_points_.data(), xyz);
}

Sample BfrFace::evaluate(int sub, double u, double v) const {
    Sample sample;
    if (!valid_)
        return sample;
    const double uv[2] = {u, v};
    double coordinate[2] = {u, v};
    Bfr::Parameterization parameterization = surface_.GetParameterization();
    if (parameterization.HasSubFaces())
        parameterization.ConvertNormalizedSubFaceToCoord(sub, uv, coordinate);
    surface_.Evaluate(coordinate, patch_points_.data(), Bfr::Surface<double>::PointDescriptor(3), &sample.position.x,
                      &sample.tangent_u.x, &sample.tangent_v.x);
    sample.valid = true;
    return sample;
}
