#include "target.h"

#include "../shared/fail.h"

static void attach_buffer(GLenum target, GLenum attachment, GLenum format, int samples, int width, int height) {
    GLuint buffer;
    glGenRenderbuffers(1, &buffer);
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
    glFramebufferRenderbuffer(target, attachment, GL_RENDERBUFFER, buffer);
}

Target::Target(int width, int height, int sample_count) : width_(width), height_(height), sample_count_(sample_count) {
    glGenFramebuffers(1, &framebuffer_);
    bind();
    attach_buffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RGBA8, sample_count, width, height);
    attach_buffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT32F, sample_count, width, height);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        fail("the framebuffer is incomplete");
}

Image Target::read() const {
    bind();
    if (sample_count_) {
        GLuint resolved;
        glGenFramebuffers(1, &resolved);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved);
        attach_buffer(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RGBA8, 0, width_, height_);
        glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
        glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved);
    }
    Image image{width_, height_, std::vector<unsigned char>((size_t)width_ * height_ * 3)};
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
    return image;
}
