// Time from left to right: a ruler in seconds and frames, the range, and foot contacts below.
#pragma once

#include <QWidget>
#include <optional>

#include "gui/common/paint_style.h"
#include "gui/time/gait_rows.h"

#include "render/chart/chart.h"

namespace marey::gui {

/// Seconds to pixels, the same for all parts of the timeline.
struct TimeAxis {
  double left = 0.0, right = 1.0;  ///< pixels
  double seconds = 1.0;
  double x(double s) const { return left + s / seconds * (right - left); }
  double at(double x) const { return (x - left) / (right - left) * seconds; }
};

/// Drag: time. Shift drag, or drag on the strip below the numbers: range.
class TimeRuler : public QWidget {
  Q_OBJECT
 public:
  TimeRuler(Workspace& workspace, QWidget* parent);
  const TimeAxis& axis() const { return m_axis; }
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return sizeHint(); }

 Q_SIGNALS:
  void axisChanged();

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;

 private:
  enum class Drag { None, Time, Range };
  void updateAxis();
  int stripTop() const;
  void paintTicks(QPainter& painter, const Inks& inks) const;
  void paintStrip(QPainter& painter, const Inks& inks) const;
  double snapped(double x) const;

  Workspace& m_workspace;
  TimeAxis m_axis;
  Drag m_drag = Drag::None;
  double m_anchorS = 0.0;
};

/// One bar per foot; drag sets the time.
class GaitView : public QWidget {
  Q_OBJECT
 public:
  GaitView(Workspace& workspace, const TimeRuler& ruler, QWidget* parent);
  void setRows(std::vector<GaitRow> rows, int leftOut);
  void setHint(const QString& hint);
  const std::vector<GaitRow>& rows() const { return m_rows; }
  /// The rows as a chart; without charts where there are none.
  render::ChartGrid chart() const;

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  bool event(QEvent* event) override;

 private:
  int rowHeight() const;
  void paintRow(QPainter& painter, const Inks& inks, const GaitRow& row, const QRectF& rect) const;

  Workspace& m_workspace;
  const TimeRuler& m_ruler;
  std::vector<GaitRow> m_rows;
  int m_leftOut = 0;
  QString m_hint;
};

}  // namespace marey::gui
