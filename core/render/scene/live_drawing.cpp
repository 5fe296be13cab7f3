// What a scene does before OpenGL draws it: poses, strokes, their order, shadows.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "render/scene/endings.h"
#include "render/scene/live_decals.h"
#include "render/scene/live_internals.h"

namespace marey::render {

namespace {
constexpr size_t manyFigures = 400;  ///< above, Auto draws lines
constexpr double ghostOpacity = 0.30;
constexpr double trailStepS = 1.0 / 30.0;

bool isSolid(double opacity) {
  return opacity > 0.995;
}
}  // namespace

bool LiveScene::Internals::useLines() const {
  if (options.detail != BodyDetail::Auto) return options.detail == BodyDetail::Lines;
  return motions.size() > manyFigures;
}

Colour LiveScene::Internals::shownColour(size_t motion, double timeS) const {
  const LiveMotion& m = motions[motion];
  Colour colour = m.colour;
  if (!m.frameColours.empty()) {
    const double last = static_cast<double>(m.frameColours.size() - 1);
    colour =
        m.frameColours[static_cast<size_t>(std::clamp(std::round(timeS * m.clip->fps), 0.0, last))];
  }
  if (options.dark) colour = onDark(colour);
  colour.a = m.highlighted ? 1.0 : std::clamp(m.opacity, 0.0, 1.0);
  colour.a *= presenceAt(timeS, tracks[motion]->lastS());
  if (m.highlighted || !someHighlighted) return colour;
  const double kept = isSolid(colour.a) ? 1.0 : 0.45 * colour.a;
  return withOpacity(mix(colour, backdropOf(options.dark).floor, 0.62), kept);
}

/// A ball on the joint. Lines, whose own batch draws one width, have a wide dot over them.
void LiveScene::Internals::addHighlightBall(FigureStrokes& figures, size_t motion) {
  const auto pose = poseOf(motion);
  const auto& joint = motions[motion].highlightJoint;
  if (!joint || *joint < 0 || *joint >= static_cast<int>(pose.size())) return;
  constexpr Rgba amber = {255, 193, 7, 255};
  const Vec3& at = pose[static_cast<size_t>(*joint)];
  const float radius = 2.0F * tracks[motion]->shape().capsules.front().radiusTo;
  if (&figures == &lineFigures)
    trailStrokes.addToLast({at, at, 3.0F, 3.0F, amber, StrokeKind::Line});
  else
    figures.addToLast({at, at, radius, radius, amber, StrokeKind::Limb});
}

/// After the trails, to which the dots of lines are added.
void LiveScene::Internals::fillFigures() {
  solidFigures.clear();
  sheerFigures.clear();
  lineFigures.clear();
  const bool asLines = useLines();
  for (size_t m = 0; m < motions.size(); ++m) {
    const Colour colour = shownColour(m, time);
    if (colour.a <= 0.0) continue;
    const bool thin = asLines && !motions[m].highlighted;
    FigureStrokes& figures = thin ? lineFigures : isSolid(colour.a) ? solidFigures : sheerFigures;
    figures.add(tracks[m]->shape(), poseOf(m), colour, thin);
    addHighlightBall(figures, m);
  }
}

void LiveScene::Internals::fillGhosts() {
  ghostFigures.clear();
  if (!(options.ghostsS > 0.0)) return;
  const bool asLines = useLines();
  std::vector<Vec3> pose;
  for (size_t m = 0; m < motions.size(); ++m) {
    pose.resize(static_cast<size_t>(tracks[m]->jointCount()));
    for (int k = 0; k * options.ghostsS <= tracks[m]->lastS() + 1e-9; ++k) {
      const double at = k * options.ghostsS;
      const Colour colour = shownColour(m, at);
      tracks[m]->pose(at, options.placement, pose);
      ghostFigures.add(tracks[m]->shape(), pose, withOpacity(colour, ghostOpacity * colour.a),
                       asLines);
    }
  }
}

void LiveScene::Internals::fillTrails() {
  trailStrokes.clear();
  if (!(options.trailS > 0.0)) return;
  constexpr float halfPixels = 1.2F;
  for (size_t m = 0; m < motions.size(); ++m) {
    const Track& track = *tracks[m];
    const double now = std::clamp(time, 0.0, track.lastS());
    const double start = std::max(0.0, time - options.trailS);
    for (const int joint : motions[m].trailJoints) {
      if (joint < 0 || joint >= track.jointCount()) continue;
      Vec3 last = track.joint(start, joint, options.placement);
      // The corners keep their places while time goes on, so that the line does not tremble.
      for (auto k = static_cast<int>(start / trailStepS) + 1;; ++k) {
        const double at = std::min(now, k * trailStepS);
        if (at <= start) break;
        const Vec3 next = track.joint(at, joint, options.placement);
        const Colour colour = shownColour(m, at);
        const double fresh = std::clamp(1.0 - (time - at) / options.trailS, 0.0, 1.0);
        trailStrokes.addToLast({last, next, halfPixels, halfPixels,
                                rgbaOf(withOpacity(colour, 0.9 * fresh * colour.a)),
                                StrokeKind::Link});
        last = next;
        if (at >= now) break;
      }
    }
  }
}

void LiveScene::Internals::fillDecals() {
  decalStrokes.clear();
  const Backdrop& backdrop = backdropOf(options.dark);
  const bool aside = options.placement == Placement::SideBySide;
  if (marksInPlace()) {
    const Colour ink = mix(backdrop.floor, backdrop.ink, 0.75);
    if (!aside) addPath(decalStrokes, options.path, Vec3::Zero(), ink);
    for (size_t m = 0; aside && m < tracks.size(); ++m)
      addPath(decalStrokes, options.path, tracks[m]->shift, ink);
  }
  for (size_t m = 0; m < motions.size(); ++m) {
    const Vec3 shift = aside ? tracks[m]->shift : Vec3::Zero();
    if (options.contactMarks && marksInPlace())
      addRests(decalStrokes, tracks[m]->rests(options.contacts), time, shift,
               shownColour(m, std::min(time, tracks[m]->lastS())));
    if (motions[m].highlighted && options.floor)
      addFootRing(decalStrokes, poseOf(m)[0], 0.42F, shownColour(m, time));
  }
}

void LiveScene::Internals::fillShadows() {
  if (!options.floor) return;
  shadowLimbs.clear();
  const bool asLines = useLines();
  for (size_t m = 0; options.shadow && m < motions.size(); ++m) {
    const auto strength = static_cast<float>(shownColour(m, time).a);
    if (strength <= 0.0F) continue;
    const auto pose = poseOf(m);
    // Of thin lines in a crowd nobody sees the shadow of each limb.
    if (asLines && !motions[m].highlighted) {
      shadowLimbs.push_back({pose[0], pose[0], 0.15F, strength});
    } else {
      addShadowLimbs(shadowLimbs, tracks[m]->shape(), pose, strength);
    }
  }
  castSoftShadows(shadowLimbs, slant, shadowMap);
  floor.setShadows(shadowMap);
}

void LiveScene::Internals::showStrokes(const Camera& from) {
  solid.set(solidFigures.strokes(), solidFigures.byStroke(from));
  const auto farFirst = lineFigures.byFigure(from);
  (thinStrokes ? lines : plainLines).set(lineFigures.strokes(), farFirst);
  (thinStrokes ? plainLines : lines).set({}, {});
  const auto inOrder = sheerFigures.byFigure(from);
  sheer.set(sheerFigures.strokes(), inOrder, sheerFigures.starts());
}

void LiveScene::Internals::showGhosts(const Camera& from) {
  const auto inOrder = ghostFigures.byFigure(from);
  StrokeBatch& asLines = thinStrokes ? ghostLines : plainGhostLines;
  StrokeBatch& used = useLines() ? asLines : ghosts;
  used.set(ghostFigures.strokes(), inOrder, ghostFigures.starts());
  for (StrokeBatch* batch : {&ghostLines, &plainGhostLines, &ghosts})
    if (batch != &used) batch->set({}, {});
}

void LiveScene::Internals::setClipping(const Camera& from) {
  const float depth = from.forward().dot(extent.centre - from.eye);
  const float reach = extent.floorRadius + extent.radius;
  // Near planes nearer than this cost the depth that keeps marks apart from the floor.
  eye->SetClippingRange(std::max(0.05F + 0.002F * extent.radius, depth - reach),
                        std::max(1.0F, depth + reach));
}

void LiveScene::Internals::setViews() {
  for (StrokeBatch* batch : {&decals, &solid, &lines, &plainLines, &trails, &ghostLines,
                             &plainGhostLines, &ghosts, &sheer})
    batch->setView({camera(), seenIn});
}

void LiveScene::Internals::draw() {
  const auto begin = std::chrono::steady_clock::now();
  std::array<int, 4> viewport{};
  auto& [left, low, width, height] = viewport;
  renderer->GetTiledSizeAndOrigin(&width, &height, &left, &low);
  width = std::max(1, width);
  height = std::max(1, height);
  const Camera from = camera();
  const bool thin = drawsThinStrokes(renderer);
  const bool moved = eye->GetMTime() != seenFrom || viewport != seenIn || thin != thinStrokes;
  seenIn = viewport;
  thinStrokes = thin;
  if (sceneChanged || timeChanged) {
    fillTrails();
    fillFigures();
    fillDecals();
    fillShadows();
    trails.set(trailStrokes.strokes(), trailStrokes.asAdded());
    decals.set(decalStrokes.strokes(), decalStrokes.asAdded());
  }
  if (sceneChanged) fillGhosts();
  if (sceneChanged || timeChanged || moved) showStrokes(from);
  if (sceneChanged || moved) {
    showGhosts(from);
    setClipping(from);
    setViews();
  }
  cost.floorCopied = floor.prepare(renderer);
  sceneChanged = timeChanged = false;
  seenFrom = eye->GetMTime();
  cost.figures = cost.strokes = 0;
  for (const FigureStrokes* some :
       {&solidFigures, &sheerFigures, &lineFigures, &ghostFigures, &trailStrokes, &decalStrokes}) {
    cost.figures += some->figures();
    cost.strokes += some->strokes().size();
  }
  cost.lines = useLines();
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - begin;
  cost.fillMs = spent.count();
}

}  // namespace marey::render
