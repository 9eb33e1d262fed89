#include "renderer.h"

#include "camera.h"
#include "patch_program.h"
#include "target.h"

#include "../shared/fail.h"

#include <opensubdiv/osd/glComputeEvaluator.h>
#include <opensubdiv/osd/glPatchTable.h>
#include <opensubdiv/osd/glVertexBuffer.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>

using namespace OpenSubdiv;

namespace {

struct PatchProgram {
    GLuint program = 0;
    GLint first_patch_location = -1;
};

std::vector<float> float_points(const Cage& cage) {
    std::vector<float> points;
    for (const Vec3& point : cage.points)
        for (double coordinate : {point.x, point.y, point.z})
            points.push_back((float)coordinate);
    return points;
}

class PatchRenderer {
public:
    PatchRenderer(const Cage& cage, const Tables& tables, const BenchOptions& options, Timings& timings)
        : options_(options), cage_points_(float_points(cage)), cage_count_((int)cage.points.size()),
          cage_buffer_(0, 3, 3), refined_buffer_(cage_count_ * 3, 3, 3) {
        timings.skip();
        points_.reset(Osd::GLVertexBuffer::Create(3, tables.point_count()));
        stencils_.reset(Osd::GLStencilTableSSBO::Create(tables.stencils.get()));
        patches_.reset(Osd::GLPatchTable::Create(tables.patches.get()));
        if (!points_ || !stencils_ || !patches_)
            fail("OpenSubdiv could not upload its tables");
        glFinish();
        timings.lap("gpu_upload");

        const Osd::BufferDescriptor no_derivatives;
        evaluator_.reset(
            Osd::GLComputeEvaluator::Create(cage_buffer_, refined_buffer_, no_derivatives, no_derivatives));
        if (!evaluator_)
            fail("OpenSubdiv could not make its compute shader");
        timings.lap("compute_shader");

        for (const Osd::PatchArray& array : patches_->GetPatchArrays()) {
            const Far::PatchDescriptor::Type type = array.GetDescriptor().GetType();
            if (!programs_.count(type))
                programs_[type].program = make_patch_program(options, type);
        }
        timings.lap("draw_shaders");

        camera_ = default_camera(cage_points_, (double)options.width / options.height);
        glGenVertexArrays(1, &vertex_array_);
        set_state();
    }

    // Uploads the points of frame `frame` and computes all others from them.
    void refine(int frame) {
        std::vector<float> points(cage_points_);
        const double amplitude = .002 * camera_.diagonal;
        for (int i = 0; i < cage_count_; ++i) {
            const double phase = .5 * frame + 3 * cage_points_[3 * i + 1] / camera_.diagonal;
            points[3 * i] += (float)(amplitude * std::sin(phase));
        }
        points_->UpdateData(points.data(), 0, cage_count_);
        evaluator_->EvalStencils(points_.get(), cage_buffer_, points_.get(), refined_buffer_, stencils_.get());
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
        glFinish();
    }

    void draw() {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glBindVertexArray(vertex_array_);
        glBindBuffer(GL_ARRAY_BUFFER, points_->BindVBO());
        glEnableVertexAttribArray(0);
        glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 3 * sizeof(float), nullptr);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, patches_->GetPatchIndexBuffer());
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_BUFFER, patches_->GetPatchParamTextureBuffer());
        for (const Osd::PatchArray& array : patches_->GetPatchArrays())
            draw_array(array);
    }

private:
    void set_state() {
        // OsdTessLevel() is the factor at level 1; with screen-space density, the height over the edge length, halved.
        const double level_1_factor =
            options_.is_screen_space() ? options_.height * .5 / options_.screen_space_pixels : options_.tess * .5;
        glViewport(0, 0, options_.width, options_.height);
        glEnable(GL_DEPTH_TEST);
        glDisable(GL_CULL_FACE);
        glClearColor(.1f, .1f, .12f, 1);
        for (auto& [type, patch_program] : programs_) {
            const GLuint program = patch_program.program;
            glUseProgram(program);
            glUniformMatrix4fv(glGetUniformLocation(program, "MV"), 1, GL_FALSE, camera_.view);
            glUniformMatrix4fv(glGetUniformLocation(program, "PROJ"), 1, GL_FALSE, camera_.projection);
            glUniform1f(glGetUniformLocation(program, "TESS"), (float)level_1_factor);
            glUniform1i(glGetUniformLocation(program, "OsdPatchParamBuffer"), 0);
            patch_program.first_patch_location = glGetUniformLocation(program, "PRIMBASE");
        }
    }

    // How many patches of so many points go in one draw.
    int patches_a_draw(int patch_size, int patch_count) const {
        if (options_.chunk >= 0)
            return options_.chunk ? options_.chunk : patch_count;
        // Mesa 22.3's llvmpipe splits a draw at about 1024 indices and starts gl_PrimitiveID at 0 again, by which
        // OpenSubdiv's shaders find the patch's parameters; and it is 20 times slower once a split yields more than
        // 65535 vertices. GL tessellates to a factor of 64 at most, and screen-space density is assumed to stay at 32.
        const double largest_factor = options_.is_screen_space() ? 32 : std::clamp(options_.tess, 2.0, 64.0);
        const int vertices_a_side = (int)std::ceil(largest_factor) + 1;
        return std::max(1, std::min(1024 / patch_size, 65535 / (vertices_a_side * vertices_a_side)));
    }

    void draw_array(const Osd::PatchArray& array) {
        const PatchProgram& patch_program = programs_[array.GetDescriptor().GetType()];
        const int patch_size = array.GetDescriptor().GetNumControlVertices();
        const int patch_count = array.GetNumPatches();
        const int step = patches_a_draw(patch_size, patch_count);
        glUseProgram(patch_program.program);
        glPatchParameteri(GL_PATCH_VERTICES, patch_size);
        for (int first = 0; first < patch_count; first += step) {
            const int index_count = std::min(step, patch_count - first) * patch_size;
            const size_t first_index = array.GetIndexBase() + first * patch_size;
            glUniform1i(patch_program.first_patch_location, array.GetPrimitiveIdBase() + first);
            glDrawElements(GL_PATCHES, index_count, GL_UNSIGNED_INT, (void*)(first_index * sizeof(GLuint)));
        }
    }

    const BenchOptions& options_;
    std::vector<float> cage_points_;
    int cage_count_;
    // Where the cage and the refined points lie in the one vertex buffer.
    Osd::BufferDescriptor cage_buffer_, refined_buffer_;
    std::unique_ptr<Osd::GLVertexBuffer> points_;
    std::unique_ptr<Osd::GLStencilTableSSBO> stencils_;
    std::unique_ptr<Osd::GLPatchTable> patches_;
    std::unique_ptr<Osd::GLComputeEvaluator> evaluator_;
    std::map<Far::PatchDescriptor::Type, PatchProgram> programs_;
    Camera camera_;
    GLuint vertex_array_ = 0;
};

} // namespace

FrameReport render_frames(const Cage& cage, const Tables& tables, const BenchOptions& options, Timings& timings) {
    timings.skip();
    make_gl_context();
    timings.lap("gl_context");

    PatchRenderer renderer(cage, tables, options, timings);
    Target target(options.width, options.height, options.sample_count);
    FrameReport report;
    report.renderer = (const char*)glGetString(GL_RENDERER);
    GLuint query;
    glGenQueries(1, &query);
    for (int frame = 0; frame < options.warmup_count + options.frame_count; ++frame) {
        const Stopwatch stopwatch;
        renderer.refine(frame);
        const double refined = stopwatch.milliseconds();
        target.bind();
        if (frame == 0)
            glBeginQuery(GL_PRIMITIVES_GENERATED, query);
        renderer.draw();
        if (frame == 0) {
            glEndQuery(GL_PRIMITIVES_GENERATED);
            glGetQueryObjectuiv(query, GL_QUERY_RESULT, &report.primitive_count);
        }
        glFinish();
        const double drawn = stopwatch.milliseconds();
        // The driver compiles the last of its shaders here.
        if (frame == 0)
            timings.set("first_frame", drawn);
        if (frame < options.warmup_count)
            continue;
        report.refine_ms.push_back(refined);
        report.draw_ms.push_back(drawn - refined);
        report.total_ms.push_back(drawn);
    }

    const Image image = target.read();
    for (size_t i = 0; i < image.rgb.size(); i += 3)
        // The background is 26, 26, 31.
        report.covered_pixel_count += image.rgb[i] >= 28 || image.rgb[i + 2] >= 34;
    if (GLenum error = glGetError())
        fprintf(stderr, "osd_bench: GL error 0x%x\n", error);
    if (!options.image.empty())
        write_image(options.image, image);
    return report;
}
