// Private to the folder: figures of a scene as strokes, and the order to draw them in.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/base/camera.h"
#include "render/scene/bodies.h"
#include "render/scene/soft_shadow.h"
#include "render/scene/strokes.h"

namespace marey::render {

/// The strokes of some figures, one figure after the other. Kept and refilled, so that a frame
/// allocates nothing.
class FigureStrokes {
 public:
  void clear();
  /// One pose (joints, metres) as capsules with a head, or as lines.
  void add(const BodyShape& shape, std::span<const Vec3> pose, const Colour& colour, bool lines);
  /// One more stroke of the figure that was added last.
  void addToLast(const Stroke& stroke) { m_strokes.push_back(stroke); }

  std::span<const Stroke> strokes() const { return m_strokes; }
  size_t figures() const { return m_firsts.size(); }
  /// From far to near: soft edges of what is near lie over what is far.
  std::span<const uint32_t> byStroke(const Camera& camera);
  /// Figures from far to near, each one's strokes together.
  std::span<const uint32_t> byFigure(const Camera& camera);
  /// Where figures begin in the last byFigure().
  std::span<const uint32_t> starts() const { return m_starts; }
  /// As they were added.
  std::span<const uint32_t> asAdded();

 private:
  void sortKeys();

  std::vector<Stroke> m_strokes;
  std::vector<uint32_t> m_firsts;  ///< first stroke of each figure
  std::vector<uint64_t> m_keys;
  std::vector<uint32_t> m_order, m_starts;
};

/// The limbs of a pose as they cast shadows; `strength` 1 is a solid figure.
void addShadowLimbs(std::vector<ShadowLimb>& limbs, const BodyShape& shape,
                    std::span<const Vec3> pose, double strength);

}  // namespace marey::render
