// What is written over the 3D view: legend, colour bar, hints, the name under the mouse.
#pragma once

#include <QWidget>
#include <functional>
#include <optional>

#include "gui/common/paint_style.h"
#include "gui/scene/scene_content.h"

namespace marey::gui {

/// Lets the mouse through.
class SceneOverlay : public QWidget {
 public:
  explicit SceneOverlay(QWidget* parent);

  void setContent(const SceneContent* content) { m_content = content; }
  /// One sentence in the middle of an empty view.
  void setHint(const QString& hint);
  const QString& hint() const { return m_hint; }
  /// What the mouse does now, along the lower edge; empty: nothing is shown.
  void setMode(const QString& text);
  void setHover(const QString& text, const QPoint& at);
  /// Drawn below everything else here, on the picture.
  void setTool(std::function<void(QPainter&, const Inks&)> paint) { m_tool = std::move(paint); }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void paintNote(QPainter& painter, const Inks& inks, const QString& text,
                 QPointF bottomLeft) const;

  const SceneContent* m_content = nullptr;
  QString m_hint, m_mode, m_hover;
  QPoint m_hoverAt;
  std::function<void(QPainter&, const Inks&)> m_tool;
};

}  // namespace marey::gui
