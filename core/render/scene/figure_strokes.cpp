#include "render/scene/figure_strokes.h"

#include <algorithm>
#include <bit>

namespace marey::render {

namespace {
/// Sorts like the number, read as an unsigned integer, far before near.
uint32_t farFirst(float depth) {
  const auto bits = std::bit_cast<uint32_t>(depth);
  const uint32_t rising = (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
  return ~rising;
}

uint64_t keyOf(float depth, size_t index) {
  return static_cast<uint64_t>(farFirst(depth)) << 32U | index;
}
}  // namespace

void FigureStrokes::clear() {
  m_strokes.clear();
  m_firsts.clear();
}

void FigureStrokes::add(const BodyShape& shape, std::span<const Vec3> pose, const Colour& colour,
                        bool lines) {
  m_firsts.push_back(static_cast<uint32_t>(m_strokes.size()));
  const Rgba plain = rgbaOf(colour);
  const Rgba left = rgbaOf(withOpacity(mix(colour, {1, 1, 1, 1}, 0.28), colour.a));
  for (const Capsule& c : shape.capsules) {
    const Vec3 &from = pose[static_cast<size_t>(c.from)], &to = pose[static_cast<size_t>(c.to)];
    const Rgba& ink = c.leftSide ? left : plain;
    if (lines) {
      m_strokes.push_back({from, to, thinLinePixels, thinLinePixels, ink, StrokeKind::Line});
    } else {
      m_strokes.push_back({from, to, c.radiusFrom, c.radiusTo, ink, StrokeKind::Limb});
    }
  }
  if (shape.head < 0 || lines) return;
  const Vec3 head = headCentre(shape, pose);
  m_strokes.push_back({head, head, shape.headRadiusM, shape.headRadiusM, plain, StrokeKind::Limb});
}

void FigureStrokes::sortKeys() {
  std::sort(m_keys.begin(), m_keys.end());
}

std::span<const uint32_t> FigureStrokes::byStroke(const Camera& camera) {
  const Vec3 forward = camera.forward();
  m_keys.clear();
  for (size_t s = 0; s < m_strokes.size(); ++s) {
    const Stroke& stroke = m_strokes[s];
    m_keys.push_back(keyOf(forward.dot(stroke.from + stroke.to), s));
  }
  sortKeys();
  m_order.clear();
  for (const uint64_t key : m_keys) m_order.push_back(static_cast<uint32_t>(key));
  return m_order;
}

std::span<const uint32_t> FigureStrokes::byFigure(const Camera& camera) {
  const Vec3 forward = camera.forward();
  m_keys.clear();
  for (size_t f = 0; f < m_firsts.size(); ++f)
    m_keys.push_back(keyOf(forward.dot(m_strokes[m_firsts[f]].from), f));
  sortKeys();
  m_order.clear();
  m_starts.clear();
  for (const uint64_t key : m_keys) {
    m_starts.push_back(static_cast<uint32_t>(m_order.size()));
    const auto figure = static_cast<uint32_t>(key);
    const size_t end = figure + 1 < m_firsts.size() ? m_firsts[figure + 1] : m_strokes.size();
    for (size_t s = m_firsts[figure]; s < end; ++s) m_order.push_back(static_cast<uint32_t>(s));
  }
  return m_order;
}

std::span<const uint32_t> FigureStrokes::asAdded() {
  m_order.clear();
  for (size_t s = 0; s < m_strokes.size(); ++s) m_order.push_back(static_cast<uint32_t>(s));
  return m_order;
}

void addShadowLimbs(std::vector<ShadowLimb>& limbs, const BodyShape& shape,
                    std::span<const Vec3> pose, double strength) {
  const auto share = static_cast<float>(strength);
  for (const Capsule& c : shape.capsules) {
    limbs.push_back({pose[static_cast<size_t>(c.from)], pose[static_cast<size_t>(c.to)],
                     0.5F * (c.radiusFrom + c.radiusTo), share});
  }
  if (shape.head < 0) return;
  const Vec3 head = headCentre(shape, pose);
  limbs.push_back({head, head, shape.headRadiusM, share});
}

}  // namespace marey::render
