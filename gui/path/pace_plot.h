// One value of the path over time, before the range of natural motion.
#pragma once

#include <QWidget>
#include <optional>
#include <vector>

#include "gui/common/paint_style.h"

#include "experiment/path_curve.h"
#include "render/chart/chart.h"

namespace marey::gui {

class PacePlot : public QWidget {
 public:
  /// `scale` turns the values into the unit of the title.
  PacePlot(const QString& name, const QString& title, double scale, QWidget* parent);

  void setValues(std::vector<double> values, double fps);
  void setNatural(std::optional<Spread> natural);
  /// A line at this time; negative: none.
  void setTime(double seconds);
  /// The curve and its bands as a chart; without charts where there is no curve.
  render::ChartGrid chart() const;
  QSize sizeHint() const override { return {260, 110}; }
  QSize minimumSizeHint() const override { return {160, 84}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  struct Frame {
    QRectF plot;
    double seconds = 1.0, low = 0.0, high = 1.0;
    QPointF at(double s, double value) const;
  };
  Frame frame() const;
  void paintBands(QPainter& painter, const Inks& inks, const Frame& frame) const;
  void paintAxes(QPainter& painter, const Inks& inks, const Frame& frame) const;
  void paintCurve(QPainter& painter, const Inks& inks, const Frame& frame) const;

  QString m_title;
  double m_scale;
  std::vector<double> m_values;
  double m_fps = 20.0;
  std::optional<Spread> m_natural;
  double m_time = -1.0;
};

}  // namespace marey::gui
