#include "limit_oracle.h"

#include "one_ring.h"

#include "../shared/fail.h"

using namespace OpenSubdiv;

LimitOracle::LimitOracle(const Cage& cage, const OracleOptions& options)
    : cage_(cage), options_(options), extent_(extent_of(cage)), refiner_(make_refiner(cage)) {
    if (!refiner_)
        fail("OpenSubdiv rejected the mesh");
    bfr_factory_.reset(new BfrFactory(*refiner_, bfr_options(options.smooth_level, options.sharp_level)));
    const bool boundary_may_lack_limit = cage.options.GetVtxBoundaryInterpolation() == Sdc::Options::VTX_BOUNDARY_NONE;
    for (int face = 0; face < cage.face_count(); ++face) {
        PtexFace ptex;
        ptex.base_face = face;
        ptex.has_limit = !base_level().IsFaceHole(face);
        if (ptex.has_limit && boundary_may_lack_limit)
            ptex.has_limit = bfr_factory_->FaceHasLimitSurface(face);
        first_ptex_.push_back(ptex_count());
        const int size = cage.face_sizes[face];
        const int count = size == cage.regular_face_size() ? 1 : size;
        for (ptex.corner = 0; ptex.corner < count; ++ptex.corner)
            ptex_faces_.push_back(ptex);
    }
}

void LimitEvaluator::use_bfr(int base_face) {
    chain_.reset();
    bfr_.reset(new BfrFace(oracle_.bfr_factory(), base_face, oracle_.cage().points.data()));
}

Sample LimitEvaluator::evaluate(int ptex, double u, double v) {
    const PtexFace& face = oracle_.ptex_face(ptex);
    if (!face.has_limit)
        return Sample();
    try {
        if (face.base_face != base_face_) {
            base_face_ = face.base_face;
            chain_.reset();
            bfr_.reset();
            if (oracle_.options().use_bfr)
                use_bfr(base_face_);
            else
                chain_.reset(new ChainNode(cut_out_one_ring(oracle_.base_level(), oracle_.cage().points.data(),
                                                            base_face_, 0, oracle_.cage())));
        }
        if (chain_)
            return chain_->evaluate(face.corner, u, v);
    } catch (Pathological&) {
        ++pathological_count_;
        use_bfr(base_face_);
    }
    return bfr_->evaluate(face.corner, u, v);
}
