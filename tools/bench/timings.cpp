#include "timings.h"

#include "../shared/json.h"

#include <sys/resource.h>

#include <algorithm>
#include <set>

std::string Timings::json() const {
    JsonObject json;
    for (const auto& [stage, milliseconds] : stages_)
        json.number(stage.c_str(), milliseconds, "%.2f");
    return json.str();
}

double Timings::preprocess_total() const {
    static const std::set<std::string> others = {"load_obj", "gl_context", "first_frame", "limit_stencils"};
    double total = 0;
    for (const auto& [stage, milliseconds] : stages_)
        if (!others.count(stage))
            total += milliseconds;
    return total;
}

double median(std::vector<double> values) {
    if (values.empty())
        return 0;
    std::sort(values.begin(), values.end());
    const size_t middle = values.size() / 2;
    return values.size() % 2 ? values[middle] : .5 * (values[middle - 1] + values[middle]);
}

double peak_resident_mib() {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024.0; // Linux counts in KiB
}
