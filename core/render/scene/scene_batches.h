// Private to the folder: the strokes of a scene as batches of OpenGL, in the order of drawing.
#pragma once

#include <array>

#include <vtkRenderer.h>

#include "render/scene/scene_strokes.h"
#include "render/scene/strokes.h"

namespace marey::render {

class SceneBatches {
 public:
  /// What lies below the figures, such as a floor, is added to the renderer before.
  explicit SceneBatches(vtkRenderer* renderer);
  /// What is drawn in the order in which it was added.
  void showMarks(SceneStrokes& strokes);
  /// Figures from far to near. `thin`: whether the window draws thin lines; see drawsThinStrokes.
  /// `solidFirst`: as of SceneOptions.
  void showFigures(SceneStrokes& strokes, const Camera& from, bool thin, bool solidFirst);
  void showStrobe(SceneStrokes& strokes, const Camera& from, bool thin, bool asLines);
  void setView(const StrokeView& view);

 private:
  StrokeBatch m_decals, m_solid, m_lines, m_plainLines, m_trails;
  StrokeBatch m_strobeLines, m_plainStrobeLines, m_strobe, m_sheer, m_solidAgain;

  std::array<StrokeBatch*, 10> all();
};

}  // namespace marey::render
