#include "render/scene/scene_strokes.h"

#include <algorithm>
#include <cmath>

#include "render/scene/backdrop.h"
#include "render/scene/decals.h"

namespace marey::render {

namespace {
constexpr double trailStepS = 1.0 / 30.0;

/// Calls use(motion, pose, colour) for every figure of the strobe.
template <class Use>
void forStrobe(const Stage& stage, Use&& use) {
  const Strobe& strobe = stage.options().strobe;
  if (!(strobe.everyS > 0.0)) return;
  constexpr double rounding = 1e-6;
  std::vector<Vec3> pose;
  for (size_t m = 0; m < stage.motions().size(); ++m) {
    const Track& track = stage.track(m);
    // One at the scene's time itself would lie in the same place as the present figure.
    const double now = stage.time() - 2.0 * rounding;
    const double last = strobe.untilNow ? std::min(now, track.lastS()) : track.lastS();
    pose.resize(static_cast<size_t>(track.jointCount()));
    for (int k = 0; k * strobe.everyS <= last + rounding; ++k) {
      const double at = k * strobe.everyS;
      const Colour colour = stage.colour(m, at);
      track.pose(at, stage.options().placement, pose);
      use(m, pose, withOpacity(colour, strobe.opacity * colour.a));
    }
  }
}
}  // namespace

/// A ball on the joint. Lines, whose own batch draws one width, have a wide dot over them.
void SceneStrokes::addHighlightBall(FigureStrokes& figures, const Stage& stage, size_t motion) {
  const auto pose = stage.pose(motion);
  const auto& joint = stage.motions()[motion].highlightJoint;
  if (!joint || *joint < 0 || *joint >= static_cast<int>(pose.size())) return;
  constexpr Rgba amber = {255, 193, 7, 255};
  const Vec3& at = pose[static_cast<size_t>(*joint)];
  const float radius = 2.0F * stage.track(motion).shape().capsules.front().radiusTo;
  if (&figures == &lines)
    trails.addToLast({at, at, 3.0F, 3.0F, amber, StrokeKind::Line});
  else
    figures.addToLast({at, at, radius, radius, amber, StrokeKind::Limb});
}

void SceneStrokes::addPresent(const Stage& stage) {
  const bool asLines = stage.asLines();
  for (size_t m = 0; m < stage.motions().size(); ++m) {
    const Colour colour = stage.colour(m, stage.time());
    if (colour.a <= 0.0) continue;
    const bool thin = asLines && !stage.motions()[m].highlighted;
    FigureStrokes& figures = thin ? lines : isSolid(colour.a) ? solid : sheer;
    const auto pose = stage.pose(m);
    figures.add(stage.track(m).shape(), pose, colour, thin);
    addHighlightBall(figures, stage, m);
    if (!stage.options().shadow) continue;
    // Of thin lines in a crowd nobody sees the shadow of each limb.
    const auto strength = static_cast<float>(colour.a);
    if (thin)
      shadows.push_back({pose[0], pose[0], 0.15F, strength});
    else
      addShadowLimbs(shadows, stage.track(m).shape(), pose, strength);
  }
}

/// Trails come first: the dots of lines are added to them.
void SceneStrokes::fillNow(const Stage& stage) {
  fillTrails(stage);
  solid.clear();
  sheer.clear();
  lines.clear();
  shadows.clear();
  if (stage.options().present) addPresent(stage);
  const bool asLines = stage.asLines();
  forStrobe(stage, [&](size_t m, std::span<const Vec3> pose, const Colour& colour) {
    const BodyShape& shape = stage.track(m).shape();
    if (isSolid(colour.a) && !asLines) solid.add(shape, pose, colour, false);
    if (stage.options().strobe.shadows && stage.options().shadow)
      addShadowLimbs(shadows, shape, pose, colour.a);
  });
  fillDecals(stage);
}

void SceneStrokes::fillStrobe(const Stage& stage) {
  strobe.clear();
  const bool asLines = stage.asLines();
  forStrobe(stage, [&](size_t m, std::span<const Vec3> pose, const Colour& colour) {
    if (asLines || !isSolid(colour.a)) strobe.add(stage.track(m).shape(), pose, colour, asLines);
  });
}

void SceneStrokes::fillTrails(const Stage& stage) {
  trails.clear();
  const SceneOptions& options = stage.options();
  const double time = stage.time();
  if (!(options.trailS > 0.0)) return;
  constexpr float halfPixels = 1.2F;
  for (size_t m = 0; m < stage.motions().size(); ++m) {
    const Track& track = stage.track(m);
    const double now = std::clamp(time, 0.0, track.lastS());
    const double start = std::max(0.0, time - options.trailS);
    for (const int joint : stage.motions()[m].trailJoints) {
      if (joint < 0 || joint >= track.jointCount()) continue;
      Vec3 last = track.joint(start, joint, options.placement);
      // The corners keep their places while time goes on, so that the line does not tremble.
      for (auto k = static_cast<int>(start / trailStepS) + 1;; ++k) {
        const double at = std::min(now, k * trailStepS);
        if (at <= start) break;
        const Vec3 next = track.joint(at, joint, options.placement);
        const Colour colour = stage.colour(m, at);
        const double fresh = std::clamp(1.0 - (time - at) / options.trailS, 0.0, 1.0);
        trails.addToLast({last, next, halfPixels, halfPixels,
                          rgbaOf(withOpacity(colour, 0.9 * fresh * colour.a)), StrokeKind::Link});
        last = next;
        if (at >= now) break;
      }
    }
  }
}

void SceneStrokes::fillDecals(const Stage& stage) {
  decals.clear();
  const SceneOptions& options = stage.options();
  const Backdrop& backdrop = backdropOf(options.tone);
  const bool aside = options.placement == Placement::SideBySide;
  const size_t count = stage.motions().size();
  if (stage.marksInPlace()) {
    const Colour ink = mix(backdrop.floor, backdrop.ink, 0.75);
    if (!aside) addPath(decals, options.path, Vec3::Zero(), ink);
    for (size_t m = 0; aside && m < count; ++m)
      addPath(decals, options.path, stage.track(m).shift, ink);
  }
  for (size_t m = 0; m < count; ++m) {
    const Track& track = stage.track(m);
    const Vec3 shift = aside ? track.shift : Vec3::Zero();
    if (options.contactMarks && stage.marksInPlace())
      addRests(decals, track.rests(options.contacts), stage.time(), shift,
               stage.colour(m, std::min(stage.time(), track.lastS())));
    if (stage.motions()[m].highlighted && options.floor)
      addFootRing(decals, stage.pose(m)[0], 0.42F, stage.colour(m, stage.time()));
  }
}

size_t SceneStrokes::figureCount() const {
  return solid.figures() + sheer.figures() + lines.figures() + strobe.figures();
}

size_t SceneStrokes::strokeCount() const {
  size_t count = 0;
  for (const FigureStrokes* some : {&solid, &sheer, &lines, &strobe, &trails, &decals})
    count += some->strokes().size();
  return count;
}

}  // namespace marey::render
