// How the path editor's top view is drawn.
#include <QPainter>
#include <algorithm>
#include <cmath>

#include "gui/path/path_view.h"

namespace marey::gui {
namespace {

/// From the legend's edge to its words, pixels: room for a stroke of the line's colour.
constexpr int kLegendIndent = 26;

/// Of grid lines and the scale bar: 1, 2 or 5 times a power of ten.
double niceStep(double atLeast) {
  const double power = std::pow(10.0, std::floor(std::log10(atLeast)));
  for (double factor : {1.0, 2.0, 5.0})
    if (factor * power >= atLeast) return factor * power;
  return 10.0 * power;
}

QColor strainInk(Strain strain, const Inks& inks) {
  if (strain == Strain::Unseen) return inks.warning;
  return strain == Strain::Rare ? inks.mildWarning : inks.accent;
}

/// Faster is thicker, pixels.
double widthOf(double speedMS) {
  return std::clamp(1.5 + 2.2 * speedMS, 1.5, 8.0);
}

}  // namespace

void PathView::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const Inks inks = inksOf(palette());
  painter.fillRect(rect(), inks.background);
  if (!m_path.path()) {
    drawHint(painter, rect(), tr("Add a path, a preset or one you draw, for motions to follow."),
             inks.faintText);
    return;
  }
  paintGrid(painter, inks);
  paintLine(painter, inks);
  paintArrows(painter, inks);
  paintKnob(painter, inks);
  paintPoints(painter, inks);
  paintNow(painter, inks);
  paintScaleBar(painter, inks);
  paintLegend(painter, inks);
}

void PathView::paintGrid(QPainter& painter, const Inks& inks) const {
  const double step = niceStep(22.0 / m_pixelsPerMetre);
  const QPointF low = toFloor(QPointF(width(), height()));
  const QPointF high = toFloor(QPointF(0, 0));
  const auto lineInk = [&](double value) {
    return std::abs(std::remainder(value, 5.0 * step)) < 0.01 * step ? inks.strongGrid : inks.grid;
  };
  for (double x = std::ceil(low.x() / step) * step; x <= high.x(); x += step) {
    painter.setPen(lineInk(x));
    const double at = toScreen(x, 0).x();
    painter.drawLine(QPointF(at, 0), QPointF(at, height()));
  }
  for (double z = std::ceil(low.y() / step) * step; z <= high.y(); z += step) {
    painter.setPen(lineInk(z));
    const double at = toScreen(0, z).y();
    painter.drawLine(QPointF(0, at), QPointF(width(), at));
  }
}

void PathView::paintLine(QPainter& painter, const Inks& inks) const {
  const PathCurve& curve = m_path.curve();
  const size_t sampled = m_path.frames().size();
  for (size_t i = 1; i < curve.frames.size(); ++i) {
    QColor ink = strainInk(i < m_strains.size() ? m_strains[i] : Strain::None, inks);
    // What the document's seconds cut off is there, but paler.
    if (i >= sampled) ink.setAlpha(70);
    painter.setPen(QPen(ink, widthOf(curve.speedMS[i]), Qt::SolidLine, Qt::RoundCap));
    painter.drawLine(toScreen(curve.frames[i - 1].x, curve.frames[i - 1].z),
                     toScreen(curve.frames[i].x, curve.frames[i].z));
  }
  if (!curve.frames.empty() || m_path.points().size() < 2) return;
  // Times that contradict each other leave no frames; the way-points still show what was drawn.
  painter.setPen(QPen(inks.error, 1.5, Qt::DashLine));
  QPolygonF line;
  for (const WayPoint& point : m_path.points()) line << toScreen(point.x, point.z);
  painter.drawPolyline(line);
}

void PathView::paintArrows(QPainter& painter, const Inks& inks) const {
  const PathCurve& curve = m_path.curve();
  const auto step = std::max<size_t>(1, static_cast<size_t>(std::lround(curve.fps / 2.0)));
  painter.setPen(QPen(inks.text, 1.4));
  QPointF last(-1e6, -1e6);
  for (size_t i = 0; i < curve.frames.size(); i += step) {
    const RootFrame& frame = curve.frames[i];
    const QPointF from = toScreen(frame.x, frame.z);
    // Where it stands still, arrows of the same place would blot each other out.
    if (std::hypot(from.x() - last.x(), from.y() - last.y()) < 14.0) continue;
    last = from;
    const QPointF along(-std::sin(frame.heading), -std::cos(frame.heading));
    const QPointF across(-along.y(), along.x());
    const QPointF tip = from + 15.0 * along;
    painter.drawLine(from, tip);
    painter.drawPolyline(
        QPolygonF({tip - 5.0 * along + 3.5 * across, tip, tip - 5.0 * along - 3.5 * across}));
  }
}

void PathView::paintPoints(QPainter& painter, const Inks& inks) const {
  const auto& points = m_path.points();
  for (size_t i = 0; i < points.size(); ++i) {
    const bool chosen = m_chosen == i;
    const QPointF at = toScreen(points[i].x, points[i].z);
    painter.setPen(QPen(chosen ? inks.text : inks.accent, chosen ? 2.5 : 1.8));
    // Open handles stand for way-points that the path will get when it is edited.
    painter.setBrush(!m_path.drawn() ? QBrush(inks.background)
                                     : QBrush(chosen ? inks.accent : inks.background));
    painter.setOpacity(m_path.drawn() || chosen ? 1.0 : 0.6);
    painter.drawEllipse(at, chosen ? 7.0 : 5.5, chosen ? 7.0 : 5.5);
    painter.setOpacity(1.0);
    painter.setPen(inks.text);
    const bool named = chosen || i == 0 || i + 1 == points.size() || points.size() <= 12;
    if (named) painter.drawText(at + QPointF(9, -7), QString::number(i + 1));
  }
}

void PathView::paintKnob(QPainter& painter, const Inks& inks) const {
  const auto at = knob();
  if (!at) return;
  const WayPoint& point = m_path.points()[*m_chosen];
  // Hollow where the body faces along the path.
  painter.setPen(QPen(inks.text, 1.8));
  painter.setBrush(point.facing ? QBrush(inks.text) : QBrush(inks.background));
  painter.drawLine(toScreen(point.x, point.z), *at);
  painter.drawEllipse(*at, 4.0, 4.0);
}

void PathView::paintNow(QPainter& painter, const Inks& inks) const {
  const auto& frames = m_path.frames();
  if (frames.empty() || m_workspace.motions().duration() <= 0.0) return;
  const auto i = static_cast<size_t>(std::lround(m_workspace.view().time() * m_path.curve().fps));
  const RootFrame& now = frames[std::min(i, frames.size() - 1)];
  painter.setPen(QPen(inks.background, 1.5));
  painter.setBrush(inks.warning);
  painter.drawEllipse(toScreen(now.x, now.z), 4.5, 4.5);
}

void PathView::paintScaleBar(QPainter& painter, const Inks& inks) const {
  const double metres = niceStep(50.0 / m_pixelsPerMetre);
  const double wide = metres * m_pixelsPerMetre;
  const double y = height() - kMargin - 4.0;
  const double x = width() - kMargin - wide;
  painter.setPen(QPen(inks.text, 1.6));
  painter.drawLine(QPointF(x, y), QPointF(x + wide, y));
  painter.drawLine(QPointF(x, y - 4), QPointF(x, y + 4));
  painter.drawLine(QPointF(x + wide, y - 4), QPointF(x + wide, y + 4));
  painter.drawText(QRectF(x - 40, y - 24, wide + 80, 20), Qt::AlignHCenter | Qt::AlignBottom,
                   tr("%1 m").arg(metres));
}

void PathView::paintLegend(QPainter& painter, const Inks& inks) const {
  struct Line {
    Strain strain;
    QString text;
  };
  std::vector<Line> lines;
  const auto has = [this](Strain strain) {
    return std::find(m_strains.begin(), m_strains.end(), strain) != m_strains.end();
  };
  const QString data =
      m_natural && !m_natural->model.empty()
          ? tr("the training data of %1").arg(QString::fromStdString(m_natural->model))
          : tr("the natural motion");
  if (has(Strain::Rare)) lines.push_back({Strain::Rare, tr("rare in %1").arg(data)});
  if (has(Strain::Unseen)) lines.push_back({Strain::Unseen, tr("beyond %1").arg(data)});
  if (lines.empty()) return;
  const QFontMetrics metrics = painter.fontMetrics();
  const int room = std::max(60, width() - 2 * (kMargin + kSpacing) - kLegendIndent);
  // A narrow dock breaks the words instead of cutting them off.
  std::vector<QRect> texts;
  QSize whole(0, 0);
  for (const Line& line : lines) {
    texts.push_back(metrics.boundingRect(QRect(0, 0, room, 1000), Qt::TextWordWrap, line.text));
    whole = {std::max(whole.width(), texts.back().width()), whole.height() + texts.back().height()};
  }
  const QRectF box(kMargin, kMargin, whole.width() + kLegendIndent + 2 * kSpacing,
                   whole.height() + kSpacing);
  drawPlate(painter, box, inks.background);
  double top = box.top() + kSpacing / 2.0;
  for (size_t i = 0; i < lines.size(); ++i) {
    const double middle = top + metrics.height() / 2.0;
    painter.setPen(QPen(strainInk(lines[i].strain, inks), 4));
    painter.drawLine(QPointF(box.left() + kSpacing, middle),
                     QPointF(box.left() + kSpacing + 18, middle));
    painter.setPen(inks.text);
    painter.drawText(
        QRectF(box.left() + kSpacing + kLegendIndent, top, texts[i].width() + 2, texts[i].height()),
        Qt::TextWordWrap, lines[i].text);
    top += texts[i].height();
  }
}

}  // namespace marey::gui
