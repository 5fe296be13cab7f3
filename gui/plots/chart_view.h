// A chart in a window: drawn by the routine that draws reports, with cursor, brush, tooltip and
// highlights over it, and ways to take it out as a file.
#pragma once

#include <QImage>
#include <QString>
#include <QWidget>
#include <functional>
#include <optional>
#include <vector>

#include "gui/plots/chart_hit.h"

#include "render/chart/chart_frame.h"

namespace marey::gui {

struct ChartSpan {
  double low = 0.0, high = 0.0;
  bool operator==(const ChartSpan&) const = default;
};

class ChartView : public QWidget {
  Q_OBJECT
 public:
  explicit ChartView(QWidget* parent = nullptr);

  /// Another grid; the zoom is kept where it still shows something. The grid's theme is replaced by
  /// that of the widget's palette; files are always light.
  void setGrid(render::ChartGrid grid);
  const render::ChartGrid& grid() const { return m_grid; }
  /// Carried by every file.
  void setRecipe(render::Recipe recipe) { m_recipe = std::move(recipe); }
  /// Proposed name of files, without ending.
  void setFileStem(const QString& stem) { m_fileStem = stem; }
  /// With a time axis, dragging brushes a range; else it zooms.
  void setTimeAxis(bool time) { m_timeAxis = time; }
  void setCursor(std::optional<double> x);
  void setRange(std::optional<ChartSpan> range);
  /// Names the motion that a curve is of; empty: the curve is of several or none.
  void setNamer(std::function<QString(const CurveRef&)> namer) { m_namer = std::move(namer); }
  void setHighlights(std::vector<ChartHighlight> highlights);
  const std::vector<ChartHighlight>& highlights() const { return m_highlights; }
  void resetZoom();
  bool zoomed() const { return m_zoom.has_value(); }

  /// Where the plots lie in the widget now.
  const std::vector<render::ChartFrame>& frames() const;
  /// What the mouse is told at a place of the widget; empty beside the plots.
  QString textAt(const QPoint& at) const;
  /// The picture without overlays.
  const QImage& picture() const;
  /// .svg, .pdf, .png or .csv. Throws UsageError, FileError.
  void saveAs(const QString& file) const;
  void copyPicture() const;

  QSize sizeHint() const override { return {640, 280}; }
  QSize minimumSizeHint() const override { return {200, 120}; }

 Q_SIGNALS:
  void clicked(const marey::gui::ChartHit& hit, Qt::KeyboardModifiers modifiers);
  /// A range was drawn along a time axis; low < high.
  void brushed(double low, double high);
  /// Double click without a zoom to reset.
  void brushCleared();
  void saveFailed(const QString& error);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;

 private:
  struct Drag {
    int chart = 0;
    int fromX = 0, toX = 0;
    bool moved = false;
  };
  void invalidate();
  /// As high as the grid needs at this width.
  void growToFit();
  void draw() const;
  render::ChartGrid shownGrid() const;
  bool drawable() const;
  int chartAt(const QPoint& at) const;
  void setZoom(ChartSpan span);
  void dragTo(const QPoint& at);
  void finishDrag();
  /// The time axis is one for all charts; else only the zoomed chart changes.
  bool zoomsChart(size_t chart) const;
  // chart_paint.cpp
  void paintRange(QPainter& painter) const;
  void drawHighlights() const;
  void paintCursor(QPainter& painter) const;
  void paintHover(QPainter& painter) const;
  QString hoverText(const ChartHit& hit) const;

  render::ChartGrid m_grid;
  render::Recipe m_recipe;
  QString m_fileStem = QStringLiteral("chart");
  bool m_timeAxis = false;
  std::optional<double> m_cursor;
  std::function<QString(const CurveRef&)> m_namer;
  std::optional<ChartSpan> m_range;
  std::vector<ChartHighlight> m_highlights;
  std::optional<ChartSpan> m_zoom;
  int m_zoomChart = 0;
  std::optional<QPoint> m_hover;
  std::optional<Drag> m_drag;
  // Drawn on demand, kept until data, size, zoom or palette change.
  mutable bool m_valid = false;
  mutable QImage m_picture;
  mutable QImage m_lit;  ///< the highlights alone, as large as the picture
  mutable render::ChartGrid m_shown;
  mutable std::vector<render::ChartFrame> m_frames;
};

}  // namespace marey::gui
