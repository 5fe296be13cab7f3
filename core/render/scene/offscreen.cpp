#include "render/scene/offscreen.h"

#include <utility>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkObjectFactory.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtk_glew.h>

#include "base/error.h"

namespace marey::render {

namespace {
/// VTK asks GLEW to load the functions of OpenGL; GLEW loads them all, then complains that there
/// is no X display to ask for the extensions of GLX, which nobody needs here. VTK would print that
/// at every picture.
class DisplaylessWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static DisplaylessWindow* New();
  vtkTypeMacro(DisplaylessWindow, vtkGenericOpenGLRenderWindow);

 protected:
  void OpenGLInitContext() override {
    if (this->Initialized) return;
    const GLenum status = glewInit();
    this->GlewInitValid = status == GLEW_OK || status == GLEW_ERROR_NO_GLX_DISPLAY;
    if (!this->GlewInitValid) {
      throw Error(
          fmt::format("no picture can be drawn: the functions of OpenGL were not found ({})",
                      reinterpret_cast<const char*>(glewGetErrorString(status))));
    }
    this->Initialized = true;
  }
};
vtkStandardNewMacro(DisplaylessWindow);

void require(bool ok, const char* step) {
  if (ok) return;
  throw Error(
      fmt::format("no picture can be drawn: {} failed (EGL error 0x{:04x}); on Debian, "
                  "libegl1 and libgl1-mesa-dri draw without a display or graphics card",
                  step, static_cast<unsigned>(eglGetError())));
}

/// Desktop OpenGL with neither a display server nor a window.
class SurfacelessContext {
 public:
  SurfacelessContext() {
    const auto getDisplay = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
        eglGetProcAddress("eglGetPlatformDisplayEXT"));
    require(getDisplay != nullptr, "eglGetPlatformDisplayEXT");
    m_display = getDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    require(m_display != EGL_NO_DISPLAY && eglInitialize(m_display, nullptr, nullptr) == EGL_TRUE,
            "opening a surfaceless display");
    require(eglBindAPI(EGL_OPENGL_API) == EGL_TRUE, "choosing desktop OpenGL");
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    require(eglChooseConfig(m_display, wanted, &config, 1, &count) == EGL_TRUE && count > 0,
            "finding a configuration");
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 3,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 2,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
    m_context = eglCreateContext(m_display, config, EGL_NO_CONTEXT, attributes);
    require(m_context != EGL_NO_CONTEXT, "creating an OpenGL 3.2 context");
  }
  ~SurfacelessContext() {
    if (m_context != EGL_NO_CONTEXT) eglDestroyContext(m_display, m_context);
  }
  SurfacelessContext(const SurfacelessContext&) = delete;
  SurfacelessContext& operator=(const SurfacelessContext&) = delete;

  /// Makes the context current while it lives.
  class Current {
   public:
    explicit Current(const SurfacelessContext& context) : m_display(context.m_display) {
      require(
          eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, context.m_context) == EGL_TRUE,
          "making the context current");
    }
    ~Current() { eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

   private:
    EGLDisplay m_display;
  };

 private:
  EGLDisplay m_display = EGL_NO_DISPLAY;
  EGLContext m_context = EGL_NO_CONTEXT;
};
}  // namespace

struct OffscreenWindow::Internals {
  SurfacelessContext context;
  vtkSmartPointer<vtkGenericOpenGLRenderWindow> window;
  vtkSmartPointer<vtkRenderer> renderer;  ///< its textures and buffers live in the context

  void draw(vtkRenderer* next, int width, int height);
};

void OffscreenWindow::Internals::draw(vtkRenderer* next, int width, int height) {
  window->SetSize(width, height);
  if (renderer != next) {
    if (renderer) window->RemoveRenderer(renderer);
    window->AddRenderer(next);
    renderer = next;
  }
  window->Render();
}

OffscreenWindow::OffscreenWindow() : m_internals(std::make_unique<Internals>()) {
  const SurfacelessContext::Current current(m_internals->context);
  auto window = vtkSmartPointer<DisplaylessWindow>::New();
  window->SetReadyForRendering(true);
  window->SetOwnContext(false);
  window->SetMultiSamples(0);
  window->SetFrameBlitModeToNoBlit();
  window->InitializeFromCurrentContext();
  window->SetIsCurrent(true);
  m_internals->window = window;
}

OffscreenWindow::~OffscreenWindow() {
  const SurfacelessContext::Current current(m_internals->context);
  if (m_internals->renderer) m_internals->window->RemoveRenderer(m_internals->renderer);
  m_internals->renderer = nullptr;
  m_internals->window->Finalize();
  m_internals->window = nullptr;
}

Rendered OffscreenWindow::render(vtkRenderer* renderer, int width, int height) {
  const SurfacelessContext::Current current(m_internals->context);
  vtkGenericOpenGLRenderWindow* window = m_internals->window;
  m_internals->draw(renderer, width, height);
  Rendered result{width, height, {}};
  auto colours = vtkSmartPointer<vtkUnsignedCharArray>::New();
  window->GetRGBACharPixelData(0, 0, width - 1, height - 1, 0, colours);
  const size_t pixels = static_cast<size_t>(width) * height;
  result.rgba.assign(colours->GetPointer(0), colours->GetPointer(0) + 4 * pixels);
  return result;
}

void OffscreenWindow::draw(vtkRenderer* renderer, int width, int height) {
  const SurfacelessContext::Current current(m_internals->context);
  m_internals->draw(renderer, width, height);
  m_internals->window->WaitForCompletion();
}

}  // namespace marey::render
