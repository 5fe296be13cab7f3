// The loss of a training run over its steps, with its checkpoints.
#pragma once

#include <QColor>
#include <QRectF>
#include <QString>
#include <QWidget>
#include <vector>

#include "model/training_run.h"
#include "render/chart/chart.h"

namespace marey::gui {

class LossChart : public QWidget {
  Q_OBJECT
 public:
  explicit LossChart(QWidget* parent = nullptr);
  void setRun(TrainingRun run);
  /// Index of the checkpoint that is lit up; -1: none.
  void setCurrent(int checkpoint);
  /// The curves as a chart; without charts where there is no run.
  render::ChartGrid chart() const;
  /// What stands above the plot, in lines that fit the width.
  struct Word {
    QString text;
    QColor ink;
    QRectF place;
  };
  std::vector<Word> legend() const;
  QRectF plot() const;  ///< below the legend

 Q_SIGNALS:
  void checkpointClicked(int index);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  bool event(QEvent* event) override;

 private:
  struct Axis {
    double low = 0.0, high = 1.0;
  };
  Axis lossAxis() const;
  double xOf(int64_t step) const;
  void paintAxes(QPainter& painter, const Axis& axis) const;
  void paintCurve(QPainter& painter, const Axis& axis, double LossRow::*value,
                  const QColor& ink) const;
  void paintCheckpoints(QPainter& painter) const;
  /// The checkpoint near a place, or -1.
  int checkpointAt(const QPoint& at) const;

  TrainingRun m_run;
  int m_current = -1;
};

}  // namespace marey::gui
