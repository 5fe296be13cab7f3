// Stick figures painted without 3D graphics: small previews beside a form.
#pragma once

#include <QColor>
#include <QWidget>
#include <memory>
#include <vector>

#include "motion/clip.h"

namespace marey::gui {

struct StickFigure {
  std::shared_ptr<const Skeleton> skeleton;
  std::vector<Vec3> joints;  ///< world, metres
  QColor colour;             ///< of both sides; invalid: left and right differ
};

/// Shows figures from one direction, without perspective, on a floor with cells of half a metre.
/// The view moves along with the first figure's root.
class StickView : public QWidget {
 public:
  explicit StickView(QWidget* parent = nullptr);
  /// `yaw`: 0 looks along -Z (at the face of who faces +Z), radians; `elevation`: 0 is level.
  void setDirection(double yaw, double elevation);
  void setTitle(const QString& title);
  /// Shown where there is no figure.
  void setHint(const QString& hint);
  void setFigures(std::vector<StickFigure> figures);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QPointF onScreen(const Vec3& world) const;
  void paintFloor(QPainter& painter, const QColor& ink) const;
  void paintFigure(QPainter& painter, const StickFigure& figure) const;

  std::vector<StickFigure> m_figures;
  QString m_title, m_hint;
  double m_yaw = 0.0, m_elevation = 0.15;
  Vec3 m_centre = {0, 0.9F, 0};
};

/// Heading of a clip's first frame by its hips, radians; 0 where they are not known.
double firstHeading(const Clip& clip);

}  // namespace marey::gui
