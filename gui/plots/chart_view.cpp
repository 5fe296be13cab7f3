#include "gui/plots/chart_view.h"

#include <QEvent>
#include <QMouseEvent>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "gui/common/theme.h"

#include "base/error.h"

namespace marey::gui {
namespace {
constexpr int kSmallestWidth = 120, kSmallestHeight = 80;
constexpr int kDragPixels = 4;

render::ChartTheme themeOf(const QPalette& palette) {
  if (!isDark(palette)) return {};
  const QColor base = palette.color(QPalette::Base);
  return render::darkTheme({base.redF(), base.greenF(), base.blueF(), 1.0});
}

QImage toQImage(const render::Image& image) {
  const QImage view(image.pixels.data(), image.width, image.height, 4 * image.width,
                    QImage::Format_RGBA8888);
  // Painting is fastest from premultiplied pixels; this copies too.
  return view.convertToFormat(QImage::Format_ARGB32_Premultiplied);
}
}  // namespace

ChartView::ChartView(QWidget* parent) : QWidget(parent) {
  setMouseTracking(true);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setAccessibleName(tr("Chart"));
}

void ChartView::setGrid(render::ChartGrid grid) {
  m_grid = std::move(grid);
  m_highlights.clear();
  m_lit = {};
  if (m_zoomChart >= static_cast<int>(m_grid.charts.size())) m_zoom.reset();
  growToFit();
  invalidate();
}

void ChartView::setCursor(std::optional<double> x) {
  if (x == m_cursor) return;
  m_cursor = x;
  update();
}

void ChartView::setRange(std::optional<ChartSpan> range) {
  if (range == m_range) return;
  m_range = range;
  update();
}

void ChartView::setHighlights(std::vector<ChartHighlight> highlights) {
  m_highlights = std::move(highlights);
  m_lit = {};
  update();
}

void ChartView::resetZoom() {
  if (!m_zoom) return;
  m_zoom.reset();
  invalidate();
}

void ChartView::invalidate() {
  m_valid = false;
  update();
}

void ChartView::growToFit() {
  const double least = render::leastHeight(m_grid, std::max(kSmallestWidth, width()));
  setMinimumHeight(std::max(minimumSizeHint().height(), static_cast<int>(std::ceil(least))));
}

bool ChartView::drawable() const {
  return !m_grid.charts.empty() && width() >= kSmallestWidth && height() >= kSmallestHeight;
}

bool ChartView::zoomsChart(size_t chart) const {
  return m_timeAxis || m_grid.shareX || static_cast<int>(chart) == m_zoomChart;
}

render::ChartGrid ChartView::shownGrid() const {
  render::ChartGrid grid = m_grid;
  grid.theme = themeOf(palette());
  for (size_t i = 0; m_zoom && i < grid.charts.size(); ++i)
    if (zoomsChart(i)) grid.charts[i].x.range = {m_zoom->low, m_zoom->high};
  return grid;
}

void ChartView::draw() const {
  if (m_valid) return;
  m_valid = true;
  m_frames.clear();
  m_picture = {};
  m_lit = {};
  if (!drawable()) return;
  m_shown = shownGrid();
  const render::ChartSize size{static_cast<double>(width()), static_cast<double>(height())};
  const double scale = devicePixelRatioF();
  m_frames = render::framesOf(m_shown, size);
  m_picture = toQImage(render::drawImage(m_shown, size, scale));
  m_picture.setDevicePixelRatio(scale);
}

const std::vector<render::ChartFrame>& ChartView::frames() const {
  draw();
  return m_frames;
}

const QImage& ChartView::picture() const {
  draw();
  return m_picture;
}

void ChartView::resizeEvent(QResizeEvent* event) {
  if (event->size().width() != event->oldSize().width()) growToFit();
  invalidate();
}

void ChartView::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) invalidate();
  QWidget::changeEvent(event);
}

int ChartView::chartAt(const QPoint& at) const {
  const auto& all = frames();
  for (size_t i = 0; i < all.size(); ++i)
    if (all[i].contains(at.x(), at.y())) return static_cast<int>(i);
  return -1;
}

void ChartView::mousePressEvent(QMouseEvent* event) {
  const int chart = chartAt(event->pos());
  if (event->button() != Qt::LeftButton || chart < 0) return;
  m_drag = Drag{.chart = chart, .fromX = event->pos().x(), .toX = event->pos().x()};
}

void ChartView::dragTo(const QPoint& at) {
  if (!m_drag || m_drag->chart >= static_cast<int>(frames().size())) return;
  const render::ChartFrame& frame = frames()[static_cast<size_t>(m_drag->chart)];
  m_drag->toX = std::clamp(at.x(), static_cast<int>(frame.left), static_cast<int>(frame.right));
  m_drag->moved = m_drag->moved || std::abs(m_drag->toX - m_drag->fromX) >= kDragPixels;
}

void ChartView::mouseMoveEvent(QMouseEvent* event) {
  m_hover = event->pos();
  dragTo(event->pos());
  update();
}

void ChartView::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton || !m_drag) return;
  dragTo(event->pos());
  if (m_drag->moved) return finishDrag();
  m_drag.reset();
  const auto hit = hitAt(m_shown, frames(), event->pos().x(), event->pos().y());
  if (hit) Q_EMIT clicked(*hit, event->modifiers());
}

void ChartView::finishDrag() {
  const Drag drag = *m_drag;
  m_drag.reset();
  update();
  // Data may have changed while the button was down.
  if (drag.chart >= static_cast<int>(frames().size())) return;
  const render::ChartFrame& frame = frames()[static_cast<size_t>(drag.chart)];
  const auto [left, right] = std::minmax(drag.fromX, drag.toX);
  const ChartSpan span{frame.dataX(left), frame.dataX(right)};
  if (!(span.high > span.low)) return;
  if (m_timeAxis) {
    Q_EMIT brushed(std::max(0.0, span.low), span.high);
    return;
  }
  m_zoomChart = drag.chart;
  setZoom(span);
}

void ChartView::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  m_drag.reset();
  if (m_zoom)
    resetZoom();
  else
    Q_EMIT brushCleared();
}

void ChartView::leaveEvent(QEvent*) {
  m_hover.reset();
  update();
}

void ChartView::setZoom(ChartSpan span) {
  m_zoom.reset();
  m_valid = false;
  // The whole axis is the limit: beyond it there is nothing to see.
  const render::ChartFrame& whole = frames()[static_cast<size_t>(m_zoomChart)];
  span = {std::max(span.low, whole.xLow), std::min(span.high, whole.xHigh)};
  const bool all = span.high - span.low > 0.999 * (whole.xHigh - whole.xLow);
  if (span.high - span.low > 1e-4 * (whole.xHigh - whole.xLow) && !all) m_zoom = span;
  invalidate();
}

void ChartView::wheelEvent(QWheelEvent* event) {
  const QPoint at = event->position().toPoint();
  const int chart = chartAt(at);
  if (chart < 0) return event->ignore();
  const render::ChartFrame frame = frames()[static_cast<size_t>(chart)];
  const QPoint turn = event->angleDelta();
  m_zoomChart = chart;
  const double x = frame.dataX(at.x()), width = frame.xHigh - frame.xLow;
  if (turn.x() != 0 || event->modifiers().testFlag(Qt::ShiftModifier)) {
    if (!m_zoom) return;
    const double shift = -width * (turn.x() + turn.y()) / 1200.0;
    setZoom({frame.xLow + shift, frame.xHigh + shift});
  } else {
    const double factor = std::pow(0.8, turn.y() / 120.0);
    setZoom({x - factor * (x - frame.xLow), x + factor * (frame.xHigh - x)});
  }
  event->accept();
}

}  // namespace marey::gui
