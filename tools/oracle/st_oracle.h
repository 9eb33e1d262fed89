#pragma once

#include "bfr_face.h"
#include "limit_oracle.h"

#include "../osd/cage.h"

#include <map>
#include <memory>
#include <vector>

// A cage with face-varying values, refined, and its values on all levels, in double.
class RefinedValues {
public:
    // One level everywhere, or, where semi-sharp rules must first decay, as far as that takes around all that is
    // irregular: the rules at seams depend on how sharp a vertex was before.
    RefinedValues(Cage&& cage, bool has_rules_that_decay);

    const Cage& cage() const { return cage_; }
    int level_count() const { return (int)values_.size(); }
    OpenSubdiv::Far::TopologyLevel level(int k) const { return refiner_->GetLevel(k); }
    const std::vector<Vec3>& values(int k) const { return values_[k]; }
    // Prepares the limit of a face of level 0 as Bfr evaluates it; false unless it is one regular patch.
    bool make_regular_surface(int face);
    Vec3 evaluate_surface(double u, double v) const;

private:
    Cage cage_;
    std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner_;
    std::vector<std::vector<Vec3>> values_;
    std::unique_ptr<OpenSubdiv::Bfr::Surface<double>> surface_;
    std::vector<double> patch_points_;
};

// A quad or a base face of some level of refined values, and the quarters of it that were asked for.
class ValueNode {
public:
    ValueNode(std::shared_ptr<RefinedValues> refined, int level, int face, int first_corner, int depth);

    // s and t at (u, v) of the face, or, where it is no quad, of the quad around its corner `sub`.
    Vec3 evaluate(int sub, double u, double v);

private:
    bool is_quad() const { return size_ == 4; }
    OpenSubdiv::Far::TopologyLevel level() const { return refined_->level(level_); }
    Cage::Index vertex(int corner) const;
    Cage::Index edge(int corner) const;
    bool may_be_regular() const;
    bool has_semi_sharp_corner() const;
    // Whether the face is one regular patch of the channel; then it has been cut out, and its surface is prepared.
    bool is_regular();
    bool has_children() const;
    // Cuts the face out with its one-ring.
    void cut_out();
    ValueNode& child(int corner);
    Vec3 evaluate_flat(double u, double v) const;

    // Shared by all threads unless it is cut out; only what is cut out is changed.
    std::shared_ptr<RefinedValues> refined_;
    int level_, face_, first_corner_, depth_, size_;
    bool is_cut_ = false, is_examined_ = false, is_regular_ = false;
    std::map<int, std::unique_ptr<ValueNode>> children_;
};

// Evaluates the face-varying values of a cage, fast where one after another they lie on the same base face. One a
// thread.
class ValueEvaluator {
public:
    ValueEvaluator(const LimitOracle& oracle, std::shared_ptr<RefinedValues> refined)
        : oracle_(oracle), refined_(std::move(refined)) {}

    // Throws Pathological where a face cannot be cut out.
    Vec3 evaluate(int ptex, double u, double v);

private:
    const LimitOracle& oracle_;
    std::shared_ptr<RefinedValues> refined_;
    int base_face_ = -1;
    std::unique_ptr<ValueNode> root_;
};
