#pragma once

#include "bfr_face.h"
#include "limit_chain.h"

#include "../osd/cage.h"

#include <memory>
#include <vector>

struct OracleOptions {
    // Ask OpenSubdiv's Bfr for every base face, with these approximation levels, instead of following a chain.
    bool use_bfr = false;
    int smooth_level = 10, sharp_level = 10;
    int thread_count = 2;
};

// Ptex numbering: a regular base face is one face of the parameter domain, an n-gon is n.
struct PtexFace {
    int base_face = 0;
    // The corner of an irregular base face around which it lies.
    int corner = 0;
    // False for holes, and beside the boundary where it is not interpolated.
    bool has_limit = false;
};

// A cage, its numbering and what all threads share to evaluate it. The cage must outlive it.
class LimitOracle {
public:
    LimitOracle(const Cage& cage, const OracleOptions& options);

    const Cage& cage() const { return cage_; }
    const OracleOptions& options() const { return options_; }
    const CageExtent& extent() const { return extent_; }
    const OpenSubdiv::Far::TopologyLevel& base_level() const { return refiner_->GetLevel(0); }
    const BfrFactory& bfr_factory() const { return *bfr_factory_; }

    int ptex_count() const { return (int)ptex_faces_.size(); }
    const PtexFace& ptex_face(int ptex) const { return ptex_faces_[ptex]; }
    int first_ptex(int base_face) const { return first_ptex_[base_face]; }

private:
    const Cage& cage_;
    OracleOptions options_;
    CageExtent extent_;
    std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner_;
    std::unique_ptr<BfrFactory> bfr_factory_;
    std::vector<PtexFace> ptex_faces_;
    std::vector<int> first_ptex_;
};

// Evaluates points, fast where one after another they lie on the same base face. One a thread.
class LimitEvaluator {
public:
    explicit LimitEvaluator(const LimitOracle& oracle) : oracle_(oracle) {}

    Sample evaluate(int ptex, double u, double v);
    // How often Bfr had to answer for a face that cannot be cut out.
    size_t pathological_count() const { return pathological_count_; }

private:
    void use_bfr(int base_face);

    const LimitOracle& oracle_;
    int base_face_ = -1;
    std::unique_ptr<ChainNode> chain_;
    std::unique_ptr<BfrFace> bfr_;
    size_t pathological_count_ = 0;
};
