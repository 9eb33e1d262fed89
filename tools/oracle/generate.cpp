#include "commands.h"
#include "dump.h"
#include "uniform.h"

#include "../shared/fail.h"

#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/primvarRefiner.h>

#include <memory>

using namespace OpenSubdiv;

void generate_limit(const LimitOracle& oracle, const GenerateOptions& options, const std::string& path) {
    const UniformLimit uniform(oracle, options.level);
    Dump dump;
    for (int face = 0; face < uniform.last_level().GetNumFaces(); ++face) {
        const FaceDomain& domain = uniform.domains[face];
        if (domain.ptex < 0)
            fail("--level 0 needs a mesh without n-gons");
        if (!oracle.ptex_face(domain.ptex).has_limit)
            continue;
        Far::ConstIndexArray vertices = uniform.last_level().GetFaceVertices(face);
        uint32_t corners[4];
        for (int i = 0; i < vertices.size(); ++i)
            corners[i] = dump.add(uniform.positions[vertices[i]], uniform.normal(vertices[i]), domain.uv[i][0],
                                  domain.uv[i][1], domain.ptex);
        for (int i = 2; i < vertices.size(); ++i)
            dump.add_triangle(corners[0], corners[i - 1], corners[i]);
    }
    write_dump(path, dump, options.ascii);
}

namespace {

struct FloatPoint {
    float xyz[3] = {0, 0, 0};

    void Clear(void* = nullptr) { xyz[0] = xyz[1] = xyz[2] = 0; }
    void AddWithWeight(const FloatPoint& other, float weight) {
        for (int i = 0; i < 3; ++i)
            xyz[i] += weight * other.xyz[i];
    }
    Vec3 to_double() const { return {xyz[0], xyz[1], xyz[2]}; }
};

// OpenSubdiv's adaptive patches over a cage, with their control points.
class FloatPatches {
public:
    FloatPatches(const Cage& cage, int isolation) : refiner_(make_refiner(cage)) {
        Far::PatchTableFactory::Options options(isolation);
        options.endCapType = Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS;
        options.useInfSharpPatch = true;
        refiner_->RefineAdaptive(options.GetRefineAdaptiveOptions());
        table_.reset(Far::PatchTableFactory::Create(*refiner_, options));
        map_.reset(new Far::PatchMap(*table_));

        const int refined_count = refiner_->GetNumVerticesTotal();
        points_.resize(refined_count + table_->GetNumLocalPoints());
        for (size_t i = 0; i < cage.points.size(); ++i) {
            const Vec3& point = cage.points[i];
            points_[i] = {{(float)point.x, (float)point.y, (float)point.z}};
        }
        Far::PrimvarRefiner primvars(*refiner_);
        FloatPoint* source = points_.data();
        for (int level = 1; level < refiner_->GetNumLevels(); ++level) {
            FloatPoint* destination = source + refiner_->GetLevel(level - 1).GetNumVertices();
            primvars.Interpolate(level, source, destination);
            source = destination;
        }
        table_->ComputeLocalPointValues(points_.data(), points_.data() + refined_count);
    }

    uint32_t add_to(Dump& dump, int ptex, double u, double v) const {
        const Far::PatchTable::PatchHandle* handle = map_->FindPatch(ptex, u, v);
        if (!handle)
            fail("no patch holds a point of the domain");
        float weights[20], weights_u[20], weights_v[20];
        table_->EvaluateBasis(*handle, (float)u, (float)v, weights, weights_u, weights_v);
        Far::ConstIndexArray control_points = table_->GetPatchVertices(*handle);
        FloatPoint position, tangent_u, tangent_v;
        for (int k = 0; k < control_points.size(); ++k) {
            const FloatPoint& point = points_[control_points[k]];
            position.AddWithWeight(point, weights[k]);
            tangent_u.AddWithWeight(point, weights_u[k]);
            tangent_v.AddWithWeight(point, weights_v[k]);
        }
        const Vec3 normal = cross(tangent_u.to_double(), tangent_v.to_double());
        return dump.add(position.to_double(), normal, u, v, ptex);
    }

private:
    std::unique_ptr<Far::TopologyRefiner> refiner_;
    std::unique_ptr<Far::PatchTable> table_;
    std::unique_ptr<Far::PatchMap> map_;
    std::vector<FloatPoint> points_;
};

void add_grid(Dump& dump, const FloatPatches& patches, int ptex, int rate, bool is_triangle) {
    std::vector<uint32_t> vertices((rate + 1) * (rate + 1));
    auto at = [&](int i, int j) -> uint32_t& {
        return vertices[j * (rate + 1) + i];
    };
    for (int j = 0; j <= rate; ++j)
        for (int i = 0; i <= (is_triangle ? rate - j : rate); ++i)
            at(i, j) = patches.add_to(dump, ptex, (double)i / rate, (double)j / rate);

    for (int j = 0; j < rate; ++j)
        for (int i = 0; i < (is_triangle ? rate - j : rate); ++i) {
            dump.add_triangle(at(i, j), at(i + 1, j), is_triangle ? at(i, j + 1) : at(i + 1, j + 1));
            if (!is_triangle)
                dump.add_triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
            else if (i + j + 2 <= rate)
                dump.add_triangle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
}

} // namespace

void generate_patch(const LimitOracle& oracle, const GenerateOptions& options, const std::string& path) {
    const FloatPatches patches(oracle.cage(), options.isolation);
    const int rate = options.rate ? options.rate : 1 << options.level;
    Dump dump;
    for (int ptex = 0; ptex < oracle.ptex_count(); ++ptex)
        if (oracle.ptex_face(ptex).has_limit)
            add_grid(dump, patches, ptex, rate, oracle.cage().is_loop());
    write_dump(path, dump, options.ascii);
}
