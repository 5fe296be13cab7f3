// Private to the folder: every limb, line and ring of a scene as strokes that face the
// viewer. One stroke is two triangles (a thin one is a line) whose round shape, light and soft edge
// are worked out per pixel: far fewer corners than a mesh of tubes, no facets, and smooth edges
// without multisampling.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <vtkRenderer.h>

#include "motion/clip.h"
#include "render/base/camera.h"
#include "render/base/colours.h"

namespace marey::render {

enum class StrokeKind : uint8_t {
  Limb = 0,       ///< round and lit; radii in metres
  Floor = 1,      ///< unlit, lies flat; radii in metres
  FloorLink = 2,  ///< the same without round ends, for rows that must not overlap
  Ring = 3,       ///< lies flat about `from`; radiusFrom is its middle, radiusTo half its width, m
  Line = 4,       ///< unlit, round ends; radii in pixels
  Link = 5,       ///< a Line without round ends
};

/// What a batch draws.
enum class StrokeLook {
  Limbs,
  LimbsAgain,  ///< limbs once more over what has been laid over them, so that they stay visible
  Flat,        ///< all the others
  Thin,        ///< Lines of at most thinLinePixels, for crowds: half the corners and fewer pixels
};
/// The largest radius of a thin line.
inline constexpr float thinLinePixels = 0.8F;
/// Whether the window of a renderer can draw thin strokes; if not, they are drawn as Flat ones.
/// Only while it draws.
bool drawsThinStrokes(vtkRenderer* renderer);

using Rgba = std::array<uint8_t, 4>;
Rgba rgbaOf(const Colour& colour);

struct Stroke {
  Vec3 from, to;
  float radiusFrom = 0.0F, radiusTo = 0.0F;
  Rgba colour{};
  StrokeKind kind = StrokeKind::Limb;
};

/// What the shaders need to know of the camera, with its clipping planes.
struct StrokeView {
  Camera camera;
  std::array<int, 4> viewport = {0, 0, 1280, 720};  ///< left, low, width, height in the window
};

/// Strokes drawn at once. Buffers are kept and rewritten in place; they grow by halves.
class StrokeBatch {
 public:
  /// `layers` above 0 is for see-through strokes: their figures are put into that many groups in
  /// the order given, and within one group nothing is seen through anything else, so that the
  /// limbs of one figure do not show through each other.
  StrokeBatch(vtkRenderer* renderer, StrokeLook look, int layers = 0);
  ~StrokeBatch();
  StrokeBatch(const StrokeBatch&) = delete;
  StrokeBatch& operator=(const StrokeBatch&) = delete;

  /// Draws strokes[order[0]], strokes[order[1]], ... until the next call; far ones first. `starts`
  /// are the places in `order` at which figures begin; only needed with layers.
  void set(std::span<const Stroke> strokes, std::span<const uint32_t> order,
           std::span<const uint32_t> starts = {});
  void setView(const StrokeView& view);

 private:
  struct Internals;
  std::unique_ptr<Internals> m_internals;
};

}  // namespace marey::render
