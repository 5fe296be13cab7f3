#include "render/kept_picture.h"

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

/// Both framebuffers have the size of the window.
void copy(const std::array<int, 4>& viewport) {
  const auto [left, low, width, height] = viewport;
  const int extent[4] = {left, left + width, low, low + height};
  vtkOpenGLFramebufferObject::Blit(extent, extent, GL_COLOR_BUFFER_BIT, GL_NEAREST);
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

bool KeptPicture::restore(vtkRenderer* renderer, const PictureKey& key) {
  if (!m_kept || key != m_last) return false;
  vtkOpenGLState* state = windowOf(renderer)->GetState();
  state->PushReadFramebufferBinding();
  m_pixels->Bind(GL_READ_FRAMEBUFFER);
  m_pixels->ActivateReadBuffer(0);
  copy(key.viewport);
  state->PopReadFramebufferBinding();
  return true;
}

void KeptPicture::keep(vtkRenderer* renderer, const PictureKey& key) {
  const bool again = m_drawn && key == m_last;
  m_last = key;
  m_drawn = true;
  m_kept = false;
  vtkOpenGLRenderWindow* window = windowOf(renderer);
  if (!again || window->GetMultiSamples() > 0) return;
  vtkOpenGLState* state = window->GetState();
  m_pixels->SetContext(window);
  state->PushFramebufferBindings();
  const auto [width, height] = key.window;
  if (m_pixels->GetFBOIndex() == 0)
    m_kept = m_pixels->PopulateFramebuffer(width, height, true, 1, VTK_UNSIGNED_CHAR, false, 0, 0);
  else {
    m_pixels->Resize(width, height);
    m_kept = true;
  }
  state->PopFramebufferBindings();
  if (!m_kept) return;
  state->PushDrawFramebufferBinding();
  m_pixels->Bind(GL_DRAW_FRAMEBUFFER);
  m_pixels->ActivateDrawBuffer(0);
  copy(key.viewport);
  state->PopDrawFramebufferBinding();
}

void KeptPicture::release(vtkWindow* window) {
  m_drawn = m_kept = false;
  m_pixels->ReleaseGraphicsResources(window);
}

}  // namespace marey::render
