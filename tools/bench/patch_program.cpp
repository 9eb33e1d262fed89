#include "patch_program.h"

#include "../shared/fail.h"

#include <opensubdiv/osd/glslPatchShaderSource.h>

#include <cstdio>
#include <cstdlib>

using OpenSubdiv::Far::PatchDescriptor;
using OpenSubdiv::Osd::GLSLPatchShaderSource;

static const char* const host_functions = R"(
uniform mat4 MV, PROJ;
uniform float TESS;
uniform int PRIMBASE;
mat4 OsdModelViewMatrix() { return MV; }
mat4 OsdProjectionMatrix() { return PROJ; }
mat4 OsdModelViewProjectionMatrix() { return PROJ * MV; }
float OsdTessLevel() { return TESS; }
int OsdGregoryQuadOffsetBase() { return 0; }
int OsdPrimitiveIdBase() { return PRIMBASE; }
int OsdBaseVertex() { return 0; }
)";

// The block is what OpenSubdiv's evaluation shader writes.
static std::string fragment_shader(bool single_crease) {
    return std::string("in block {\n    OutputVertex v;\n") + (single_crease ? "    vec2 vSegments;\n" : "") +
           R"(} inpt;
layout(location = 0) out vec4 col;
void main() {
    float d = abs(dot(normalize(inpt.v.normal), normalize(inpt.v.position.xyz)));
    col = vec4(vec3(.4, .6, .9) * (.15 + .85 * d), 1);
}
)";
}

static std::string common_source(const BenchOptions& options, bool single_crease) {
    std::string source = "#version 430\n";
    if (options.is_screen_space())
        source += "#define OSD_ENABLE_SCREENSPACE_TESSELLATION\n";
    if (options.spacing == "fractional_odd")
        source += "#define OSD_FRACTIONAL_ODD_SPACING\n";
    if (options.spacing == "fractional_even")
        source += "#define OSD_FRACTIONAL_EVEN_SPACING\n";
    if (options.cull)
        source += "#define OSD_ENABLE_PATCH_CULL\n";
    if (single_crease)
        source += "#define OSD_PATCH_ENABLE_SINGLE_CREASE\n";
    return source + GLSLPatchShaderSource::GetCommonShaderSource() + host_functions;
}

static GLuint compile(GLenum stage, const std::string& source) {
    const GLuint shader = glCreateShader(stage);
    const char* text = source.c_str();
    GLint compiled = 0;
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (!compiled) {
        char log[4096];
        glGetShaderInfoLog(shader, sizeof log, nullptr, log);
        if (getenv("OSD_BENCH_DUMP"))
            fprintf(stderr, "%s\n", text);
        fail(std::string("shader: ") + log);
    }
    return shader;
}

GLuint make_patch_program(const BenchOptions& options, PatchDescriptor::Type type) {
    const bool single_crease = options.single_crease && type == PatchDescriptor::REGULAR;
    const std::string common = common_source(options, single_crease);
    const GLuint shaders[] = {
        compile(GL_VERTEX_SHADER, common + GLSLPatchShaderSource::GetVertexShaderSource(type)),
        compile(GL_TESS_CONTROL_SHADER, common + GLSLPatchShaderSource::GetTessControlShaderSource(type)),
        compile(GL_TESS_EVALUATION_SHADER, common + GLSLPatchShaderSource::GetTessEvalShaderSource(type)),
        compile(GL_FRAGMENT_SHADER, common + fragment_shader(single_crease))};
    const GLuint program = glCreateProgram();
    for (GLuint shader : shaders)
        glAttachShader(program, shader);
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (!linked) {
        char log[4096];
        glGetProgramInfoLog(program, sizeof log, nullptr, log);
        fail(std::string("link: ") + log);
    }
    for (GLuint shader : shaders)
        glDeleteShader(shader);
    return program;
}
