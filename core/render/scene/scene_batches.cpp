#include "render/scene/scene_batches.h"

namespace marey::render {

namespace {
/// Of see-through figures: within one, nearer figures hide those behind them. There are more of
/// the strobe, and they do not move from one drawing to the next.
constexpr int presentLayers = 8, strobeLayers = 24;
}  // namespace

SceneBatches::SceneBatches(vtkRenderer* renderer)
    : m_decals(renderer, StrokeLook::Flat),
      m_solid(renderer, StrokeLook::Limbs),
      m_lines(renderer, StrokeLook::Thin),
      m_plainLines(renderer, StrokeLook::Flat),
      m_trails(renderer, StrokeLook::Flat),
      m_strobeLines(renderer, StrokeLook::Thin),
      m_plainStrobeLines(renderer, StrokeLook::Flat),
      m_strobe(renderer, StrokeLook::Limbs, strobeLayers),
      m_sheer(renderer, StrokeLook::Limbs, presentLayers),
      m_solidAgain(renderer, StrokeLook::LimbsAgain) {}

std::array<StrokeBatch*, 10> SceneBatches::all() {
  return {&m_decals,           &m_solid,  &m_lines, &m_plainLines, &m_trails, &m_strobeLines,
          &m_plainStrobeLines, &m_strobe, &m_sheer, &m_solidAgain};
}

void SceneBatches::showMarks(SceneStrokes& strokes) {
  m_trails.set(strokes.trails.strokes(), strokes.trails.asAdded());
  m_decals.set(strokes.decals.strokes(), strokes.decals.asAdded());
}

void SceneBatches::showFigures(SceneStrokes& strokes, const Camera& from, bool thin,
                               bool solidFirst) {
  const auto solidOrder = strokes.solid.byStroke(from);
  m_solid.set(strokes.solid.strokes(), solidOrder);
  const bool seenThrough = strokes.sheer.figures() + strokes.strobe.figures() > 0;
  if (solidFirst && seenThrough)
    m_solidAgain.set(strokes.solid.strokes(), solidOrder);
  else
    m_solidAgain.set({}, {});
  const auto farFirst = strokes.lines.byFigure(from);
  (thin ? m_lines : m_plainLines).set(strokes.lines.strokes(), farFirst);
  (thin ? m_plainLines : m_lines).set({}, {});
  const auto inOrder = strokes.sheer.byFigure(from);
  m_sheer.set(strokes.sheer.strokes(), inOrder, strokes.sheer.starts());
}

void SceneBatches::showStrobe(SceneStrokes& strokes, const Camera& from, bool thin, bool asLines) {
  const auto inOrder = strokes.strobe.byFigure(from);
  StrokeBatch& used = !asLines ? m_strobe : thin ? m_strobeLines : m_plainStrobeLines;
  used.set(strokes.strobe.strokes(), inOrder, strokes.strobe.starts());
  for (StrokeBatch* batch : {&m_strobeLines, &m_plainStrobeLines, &m_strobe})
    if (batch != &used) batch->set({}, {});
}

void SceneBatches::setView(const StrokeView& view) {
  for (StrokeBatch* batch : all()) batch->setView(view);
}

}  // namespace marey::render
