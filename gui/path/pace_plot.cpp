#include "gui/path/pace_plot.h"

#include <QPainter>
#include <algorithm>
#include <cmath>
#include <limits>

#include "render/chart/ticks.h"

namespace marey::gui {
namespace {
constexpr double kAxisLeft = 46.0;
}  // namespace

PacePlot::PacePlot(const QString& name, const QString& title, double scale, QWidget* parent)
    : QWidget(parent), m_title(title), m_scale(scale) {
  setObjectName(name);
  setAccessibleName(title);
  setFont(readableFont(font()));
  setToolTip(
      tr("Bands: speeds and turns that are known, the usual ones darker. Orange: the path "
         "leaves them."));
}

void PacePlot::setValues(std::vector<double> values, double fps) {
  m_values = std::move(values);
  m_fps = fps;
  update();
}

void PacePlot::setNatural(std::optional<Spread> natural) {
  m_natural = natural;
  update();
}

void PacePlot::setTime(double seconds) {
  if (seconds == m_time) return;
  m_time = seconds;
  update();
}

QPointF PacePlot::Frame::at(double s, double value) const {
  return {plot.left() + s / seconds * plot.width(),
          plot.bottom() - (value - low) / (high - low) * plot.height()};
}

PacePlot::Frame PacePlot::frame() const {
  const int line = fontMetrics().height();
  Frame out;
  out.plot = QRectF(rect()).adjusted(kAxisLeft, line + 6, -kMargin, -line - 6);
  double low = 0.0;
  double high = 0.0;
  for (double value : m_values) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  // The middle of natural motion is always in sight, its rare ends need not be.
  if (m_natural) {
    low = std::min(low, m_natural->low);
    high = std::max(high, m_natural->high);
  }
  const double edge = 0.08 * std::max(1e-3, high - low);
  out.low = low < 0.0 ? low - edge : low;
  out.high = high + edge;
  out.seconds = std::max(1.0 / m_fps, (static_cast<double>(m_values.size()) - 1.0) / m_fps);
  return out;
}

void PacePlot::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const Inks inks = inksOf(palette());
  painter.fillRect(rect(), inks.background);
  painter.setPen(inks.text);
  painter.drawText(QRectF(kMargin, 2, width() - 2 * kMargin, fontMetrics().height() + 2),
                   Qt::AlignLeft | Qt::AlignVCenter, m_title);
  if (m_values.size() < 2) return;
  const Frame shown = frame();
  paintBands(painter, inks, shown);
  paintAxes(painter, inks, shown);
  paintCurve(painter, inks, shown);
  if (m_time < 0.0 || m_time > shown.seconds) return;
  painter.setPen(QPen(inks.warning, 1.2));
  painter.drawLine(shown.at(m_time, shown.low), shown.at(m_time, shown.high));
}

render::ChartGrid PacePlot::chart() const {
  if (m_values.size() < 2) return {};
  const double seconds = frame().seconds;
  render::Chart chart{.title = m_title.toStdString(),
                      .x = {.label = tr("time").toStdString(), .unit = "s"}};
  const auto band = [&](double low, double high, const QString& name, double opacity) {
    chart.series.push_back({.kind = render::SeriesKind::Band,
                            .name = name.toStdString(),
                            .colour = render::grey(0.2),
                            .x = {0.0, seconds},
                            .low = {m_scale * low, m_scale * low},
                            .high = {m_scale * high, m_scale * high},
                            .opacity = opacity});
  };
  if (m_natural) {
    band(m_natural->minimum, m_natural->maximum, tr("all natural motion"), 0.08);
    band(m_natural->low, m_natural->high, tr("5 to 95 % of it"), 0.16);
  }
  render::Series line{.name = tr("path").toStdString(), .colour = render::colourOf(0)};
  render::Series strained{
      .name = tr("rare or unseen").toStdString(), .colour = render::colourOf(1), .width = 3.0};
  bool any = false;
  for (size_t i = 0; i < m_values.size(); ++i) {
    const bool rare = m_natural && strainOf(m_values[i], *m_natural) != Strain::None;
    any = any || rare;
    for (render::Series* series : {&line, &strained})
      series->x.push_back(static_cast<double>(i) / m_fps);
    line.y.push_back(m_scale * m_values[i]);
    strained.y.push_back(rare ? line.y.back() : std::numeric_limits<double>::quiet_NaN());
  }
  chart.series.push_back(std::move(line));
  if (any) chart.series.push_back(std::move(strained));
  return render::single(std::move(chart));
}

void PacePlot::paintBands(QPainter& painter, const Inks& inks, const Frame& frame) const {
  if (!m_natural) return;
  const auto band = [&](double low, double high, double opacity) {
    QColor ink = inks.text;
    ink.setAlphaF(opacity);
    const double top = frame.at(0, std::clamp(high, frame.low, frame.high)).y();
    const double bottom = frame.at(0, std::clamp(low, frame.low, frame.high)).y();
    painter.fillRect(QRectF(frame.plot.left(), top, frame.plot.width(), bottom - top), ink);
  };
  band(m_natural->minimum, m_natural->maximum, 0.06);
  band(m_natural->low, m_natural->high, 0.11);
  const auto number = [this](double value) {
    const double shown = value * m_scale;
    return QString::number(shown, 'f', std::abs(shown) >= 10.0 ? 0 : 2);
  };
  const QString text = tr("usual %1 to %2").arg(number(m_natural->low), number(m_natural->high));
  const int free = width() - fontMetrics().horizontalAdvance(m_title) - 4 * kMargin;
  painter.setPen(inks.faintText);
  painter.drawText(QRectF(width() - free - kMargin, 2, free, fontMetrics().height() + 2),
                   Qt::AlignRight | Qt::AlignVCenter,
                   fontMetrics().elidedText(text, Qt::ElideRight, free));
}

void PacePlot::paintAxes(QPainter& painter, const Inks& inks, const Frame& frame) const {
  const int line = fontMetrics().height();
  const int rows = std::max(2, static_cast<int>(frame.plot.height() / (1.6 * line)));
  const auto values = render::niceTicks(frame.low * m_scale, frame.high * m_scale, rows);
  for (size_t i = 0; i < values.values.size(); ++i) {
    const double y = frame.at(0, values.values[i] / m_scale).y();
    painter.setPen(inks.grid);
    painter.drawLine(QPointF(frame.plot.left(), y), QPointF(frame.plot.right(), y));
    painter.setPen(inks.faintText);
    painter.drawText(QRectF(0, y - line / 2.0, kAxisLeft - 5, line),
                     Qt::AlignRight | Qt::AlignVCenter, QString::fromStdString(values.labels[i]));
  }
  const int columns = std::max(2, static_cast<int>(frame.plot.width() / 60));
  const auto times = render::niceTicks(0.0, frame.seconds, columns);
  for (size_t i = 0; i < times.values.size(); ++i) {
    const double x = frame.at(times.values[i], frame.low).x();
    painter.setPen(inks.strongGrid);
    painter.drawLine(QPointF(x, frame.plot.bottom()), QPointF(x, frame.plot.bottom() + 4));
    painter.setPen(inks.faintText);
    QString label = QString::fromStdString(times.labels[i]);
    if (i + 1 == times.values.size()) label += tr(" s");
    painter.drawText(QRectF(x - 30, frame.plot.bottom() + 4, 60, line), Qt::AlignHCenter, label);
  }
}

void PacePlot::paintCurve(QPainter& painter, const Inks& inks, const Frame& frame) const {
  for (size_t i = 1; i < m_values.size(); ++i) {
    const Strain strain = m_natural ? strainOf(m_values[i], *m_natural) : Strain::None;
    const QColor ink = strain == Strain::Unseen ? inks.warning
                       : strain == Strain::Rare ? inks.mildWarning
                                                : inks.accent;
    painter.setPen(QPen(ink, strain == Strain::None ? 1.8 : 3.0, Qt::SolidLine, Qt::RoundCap));
    painter.drawLine(frame.at(static_cast<double>(i - 1) / m_fps, m_values[i - 1]),
                     frame.at(static_cast<double>(i) / m_fps, m_values[i]));
  }
}

}  // namespace marey::gui
