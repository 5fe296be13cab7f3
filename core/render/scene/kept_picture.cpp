#include "render/scene/kept_picture.h"

#include <algorithm>

#include <vtkCamera.h>
#include <vtkMatrix4x4.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtk_glew.h>

namespace marey::render {

namespace {
vtkOpenGLRenderWindow* windowOf(vtkRenderer* renderer) {
  return static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow());
}

/// Both framebuffers have the size of the window. Where nothing is cut off, software drivers copy
/// memory instead of drawing.
void copy(vtkOpenGLState* state, const std::array<int, 4>& viewport) {
  const vtkOpenGLState::ScopedglEnableDisable cut(state, GL_SCISSOR_TEST);
  state->vtkglDisable(GL_SCISSOR_TEST);
  const auto [left, low, width, height] = viewport;
  const int extent[4] = {left, left + width, low, low + height};
  vtkOpenGLFramebufferObject::Blit(extent, extent, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT,
                                   GL_NEAREST);
}
}  // namespace

PictureKey PictureKey::of(vtkRenderer* renderer, uint64_t look) {
  PictureKey key;
  const vtkMatrix4x4* projection =
      renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(
          renderer->GetTiledAspectRatio(), -1.0, 1.0);
  std::copy_n(projection->GetData(), key.projection.size(), key.projection.data());
  renderer->GetBackground(key.background.data());
  auto& [left, low, width, height] = key.viewport;
  renderer->GetTiledSizeAndOrigin(&width, &height, &left, &low);
  const int* size = windowOf(renderer)->GetSize();
  key.window = {size[0], size[1]};
  key.look = look;
  return key;
}

void KeptPicture::restore(vtkRenderer* renderer) const {
  vtkOpenGLState* state = windowOf(renderer)->GetState();
  state->PushReadFramebufferBinding();
  m_pixels->Bind(GL_READ_FRAMEBUFFER);
  m_pixels->ActivateReadBuffer(0);
  copy(state, m_last.viewport);
  state->PopReadFramebufferBinding();
}

void KeptPicture::keep(vtkRenderer* renderer, const PictureKey& key) {
  const bool again = m_drawn && key == m_last;
  m_last = key;
  m_drawn = true;
  m_kept = again && take(windowOf(renderer));
}

bool KeptPicture::take(vtkOpenGLRenderWindow* window) {
  if (m_refused || window->GetMultiSamples() > 0 || !makeRoom(window)) return false;
  while (glGetError() != GL_NO_ERROR) continue;
  vtkOpenGLState* state = window->GetState();
  state->PushDrawFramebufferBinding();
  m_pixels->Bind(GL_DRAW_FRAMEBUFFER);
  m_pixels->ActivateDrawBuffer(0);
  copy(state, m_last.viewport);
  state->PopDrawFramebufferBinding();
  // Depth is only copied between equal formats, and a window may have been given another one.
  m_refused = glGetError() != GL_NO_ERROR;
  return !m_refused;
}

bool KeptPicture::makeRoom(vtkOpenGLRenderWindow* window) {
  const auto [width, height] = m_last.window;
  vtkOpenGLState* state = window->GetState();
  state->PushFramebufferBindings();
  m_pixels->SetContext(window);
  bool made = true;
  if (m_pixels->GetFBOIndex() == 0) {
    // As VTK makes that of the window.
    made = m_pixels->PopulateFramebuffer(width, height, true, 1, VTK_UNSIGNED_CHAR, true, 32, 0,
                                         window->GetStencilCapable() != 0);
  } else {
    m_pixels->Resize(width, height);
  }
  state->PopFramebufferBindings();
  return made;
}

void KeptPicture::release(vtkWindow* window) {
  m_drawn = m_kept = m_refused = false;
  m_pixels->ReleaseGraphicsResources(window);
}

}  // namespace marey::render
