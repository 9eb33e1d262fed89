#pragma once

#include "../shared/stopwatch.h"

#include <map>
#include <string>
#include <vector>

// Named stages and the milliseconds that they took.
class Timings {
public:
    // Ends the current stage: the time since the last call is its.
    void lap(const char* stage) {
        set(stage, stopwatch_.milliseconds());
        stopwatch_.restart();
    }
    // The time until now belongs to no stage.
    void skip() { stopwatch_.restart(); }
    void set(const char* stage, double milliseconds) { stages_[stage] = milliseconds; }

    std::string json() const;
    // Of the stages that prepare a mesh for drawing.
    double preprocess_total() const;

private:
    Stopwatch stopwatch_;
    std::map<std::string, double> stages_;
};

// 0 where there are none.
double median(std::vector<double> values);

double peak_resident_mib();
