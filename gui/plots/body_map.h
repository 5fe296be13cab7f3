// The body from the front (quadrupeds from the side), each joint in the colour of a value.
#pragma once

#include <QString>
#include <QWidget>
#include <memory>
#include <optional>
#include <vector>

#include "motion/clip.h"
#include "render/chart/chart.h"

namespace marey::gui {

struct BodyMapData {
  std::shared_ptr<const Skeleton> skeleton;
  std::vector<Vec3> pose;      ///< root frame: x left, y up, z ahead; metres
  std::vector<double> values;  ///< one per joint; NaN: none. Empty: joints without colours
  QString label;               ///< of the colour bar, with its unit
};

class BodyMap : public QWidget {
  Q_OBJECT
 public:
  explicit BodyMap(QWidget* parent = nullptr);
  void setData(BodyMapData data);
  void setJoint(std::optional<int> joint);
  /// Where a joint is drawn.
  QPointF placeOf(int joint) const;
  /// The body, and beside it the value of every joint; without charts where there is no body.
  render::ChartGrid chart() const;
  QSize sizeHint() const override { return {190, 260}; }
  QSize minimumSizeHint() const override { return {130, 160}; }

 Q_SIGNALS:
  void jointClicked(int joint);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  bool event(QEvent* event) override;

 private:
  int jointAt(const QPoint& at) const;
  double highest() const;
  void paintBar(QPainter& painter) const;

  BodyMapData m_data;
  std::optional<int> m_joint;
};

/// Cividis (Nuñez et al. 2018): the same order of lightness and hue for every kind of vision.
/// 0 is dark blue, 1 is yellow.
QColor mapColour(double share);

}  // namespace marey::gui
