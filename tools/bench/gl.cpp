#include "gl.h"

#include "../shared/fail.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

void make_gl_context() {
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr))
        fail("no surfaceless EGL display");
    if (!eglBindAPI(EGL_OPENGL_API))
        fail("EGL has no desktop GL");
    const EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
        fail("no GL 4.5 context");
    glewExperimental = GL_TRUE;
    // Its status says that GLX is missing, and the errors are its own; GL's entry points are loaded all the same.
    glewInit();
    while (glGetError()) {
    }
    if (!glPatchParameteri || !glDispatchCompute)
        fail("GLEW did not load GL 4.5");
}
