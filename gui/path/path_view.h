// The current path from above, with way-points to drag. North is where the character faces at the
// start (+Z); its left (+X) is on the left.
#pragma once

#include <QWidget>
#include <optional>

#include "gui/common/paint_style.h"
#include "gui/path/current_path.h"

namespace marey::gui {

class PathView : public QWidget {
  Q_OBJECT
 public:
  PathView(Workspace& workspace, CurrentPath& path, QWidget* parent);

  void setNatural(const std::optional<PaceRange>& natural);
  std::optional<size_t> chosen() const { return m_chosen; }
  void choose(std::optional<size_t> index);
  void removeChosen();
  /// Shows all of the path.
  void fit();
  QPointF toScreen(double x, double z) const;
  /// Where the knob is that turns the chosen way-point's body; none where none is chosen.
  std::optional<QPointF> knob() const;

 Q_SIGNALS:
  void chosenChanged();

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;

 private:
  enum class Drag { None, Shift, WayPoint, Facing };
  QPointF toFloor(const QPointF& screen) const;  ///< (x, z)
  std::optional<size_t> wayPointAt(const QPointF& at) const;
  bool atKnob(const QPointF& at) const;
  void dragChosen(const QPointF& to);
  void pathChanged();
  void paintGrid(QPainter& painter, const Inks& inks) const;
  void paintScaleBar(QPainter& painter, const Inks& inks) const;
  void paintLine(QPainter& painter, const Inks& inks) const;
  void paintArrows(QPainter& painter, const Inks& inks) const;
  void paintPoints(QPainter& painter, const Inks& inks) const;
  void paintKnob(QPainter& painter, const Inks& inks) const;
  void paintLegend(QPainter& painter, const Inks& inks) const;
  void paintNow(QPainter& painter, const Inks& inks) const;

  Workspace& m_workspace;
  CurrentPath& m_path;
  std::optional<PaceRange> m_natural;
  std::vector<Strain> m_strains;
  std::optional<size_t> m_chosen;
  std::string m_shownName;  ///< another path is fitted, an edit of this one is not
  double m_pixelsPerMetre = 60.0;
  QPointF m_centre;        ///< of the view, metres (x, z)
  bool m_touched = false;  ///< the user has zoomed or shifted
  Drag m_drag = Drag::None;
  QPointF m_last;
  bool m_moved = false;
};

}  // namespace marey::gui
