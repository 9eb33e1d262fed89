#pragma once

#include "gl.h"
#include "image.h"

// A framebuffer of RGBA8 and 32-bit float depth. It lives as long as the context.
class Target {
public:
    // No multisampling with 0 samples.
    Target(int width, int height, int sample_count);

    void bind() const { glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_); }
    Image read() const;

private:
    int width_, height_, sample_count_;
    GLuint framebuffer_ = 0;
};
