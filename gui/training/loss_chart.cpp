#include "gui/training/loss_chart.h"

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QToolTip>
#include <algorithm>
#include <cmath>

#include "gui/common/paint_style.h"

namespace marey::gui {
namespace {
constexpr double kLeft = 56.0, kRight = 12.0, kBottom = 34.0;
constexpr double kLegendLeft = 8.0, kLegendGap = 14.0;
constexpr double kNear = 6.0;  ///< pixels
/// The first steps are far off; the curves show where the rest happens.
constexpr double kLowQuantile = 0.0, kHighQuantile = 0.97;
}  // namespace

LossChart::LossChart(QWidget* parent) : QWidget(parent) {
  setMinimumSize(180, 130);
  setFont(readableFont(font()));
  setAccessibleName(tr("Loss over training steps"));
}

void LossChart::setRun(TrainingRun run) {
  m_run = std::move(run);
  update();
}

void LossChart::setCurrent(int checkpoint) {
  m_current = checkpoint;
  update();
}

QRectF LossChart::plot() const {
  const auto words = legend();
  return QRectF(rect()).adjusted(kLeft, words.back().place.bottom() + 6.0, -kRight, -kBottom);
}

std::vector<LossChart::Word> LossChart::legend() const {
  const Inks inks = inksOf(palette());
  const bool dark = isDark(palette());
  const QFontMetricsF metrics(font());
  std::vector<Word> words{{tr("Bits per frame:"), inks.text, {}},
                          {tr("training"), inks.faintText, {}},
                          {tr("validation"), shownColour(render::colourOf(0), dark), {}},
                          {tr("test"), shownColour(render::colourOf(1), dark), {}}};
  QPointF at(kLegendLeft, 4.0);
  for (Word& word : words) {
    const double width = metrics.horizontalAdvance(word.text);
    if (at.x() > kLegendLeft && at.x() + width > this->width() - kRight)
      at = {kLegendLeft, at.y() + metrics.height()};
    word.place = QRectF(at, QSizeF(width, metrics.height()));
    at.rx() += width + kLegendGap;
  }
  return words;
}

LossChart::Axis LossChart::lossAxis() const {
  std::vector<double> values;
  for (const LossRow& row : m_run.rows)
    for (const double value : {row.train, row.valid, row.test})
      if (std::isfinite(value)) values.push_back(value);
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1))];
  };
  const double low = at(kLowQuantile), high = at(kHighQuantile);
  const double room = std::max(1e-6, 0.05 * (high - low));
  return {low - room, high + room};
}

double LossChart::xOf(int64_t step) const {
  const double last =
      m_run.rows.empty() ? 1.0 : static_cast<double>(std::max<int64_t>(1, m_run.rows.back().step));
  return plot().left() + plot().width() * std::min(1.0, static_cast<double>(step) / last);
}

void LossChart::paintAxes(QPainter& painter, const Axis& axis) const {
  const Inks inks = inksOf(palette());
  const QRectF area = plot();
  constexpr int kTicks = 4;
  for (int i = 0; i <= kTicks; ++i) {
    const double share = static_cast<double>(i) / kTicks;
    const double y = area.bottom() - share * area.height();
    painter.setPen(inks.grid);
    painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y));
    painter.setPen(inks.faintText);
    painter.drawText(QRectF(0, y - 10, kLeft - 6, 20), Qt::AlignRight | Qt::AlignVCenter,
                     QString::number(axis.low + share * (axis.high - axis.low), 'f', 0));
    const double step = share * static_cast<double>(m_run.rows.back().step);
    const double x = area.left() + share * area.width();
    const Qt::Alignment side = i == kTicks ? Qt::AlignRight : Qt::AlignHCenter;
    painter.drawText(QRectF(x - (i == kTicks ? 80 : 40), area.bottom() + 4, 80, 16),
                     side | Qt::AlignTop, QString::number(step, 'f', 0));
  }
  painter.drawText(QRectF(area.left(), area.bottom() + 16, area.width(), 18), Qt::AlignCenter,
                   tr("training steps"));
}

void LossChart::paintCurve(QPainter& painter, const Axis& axis, double LossRow::*value,
                           const QColor& ink) const {
  const QRectF area = plot();
  QPainterPath path;
  bool down = false;
  for (const LossRow& row : m_run.rows) {
    if (!std::isfinite(row.*value)) {
      down = false;
      continue;
    }
    const QPointF at(xOf(row.step), area.bottom() - area.height() * (row.*value - axis.low) /
                                                        (axis.high - axis.low));
    if (down)
      path.lineTo(at);
    else
      path.moveTo(at);
    down = true;
  }
  painter.save();
  painter.setClipRect(area.adjusted(-1, -1, 1, 1));
  painter.strokePath(path, QPen(ink, 2));
  painter.restore();
}

void LossChart::paintCheckpoints(QPainter& painter) const {
  const Inks inks = inksOf(palette());
  const QRectF area = plot();
  for (size_t i = 0; i < m_run.checkpoints.size(); ++i) {
    const double x = xOf(m_run.checkpoints[i].step);
    const bool current = static_cast<int>(i) == m_current;
    painter.setPen(QPen(current ? inks.accent : inks.faintText, current ? 2 : 1, Qt::DashLine));
    painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()));
    painter.setPen(Qt::NoPen);
    painter.setBrush(
        toQColor(render::colourOf(render::stageIndex(stageOf(m_run, m_run.checkpoints[i])))));
    painter.drawEllipse(QPointF(x, area.bottom()), current ? 6 : 5, current ? 6 : 5);
  }
}

void LossChart::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const Inks inks = inksOf(palette());
  painter.fillRect(rect(), inks.background);
  if (m_run.rows.empty()) {
    drawHint(painter, rect(), tr("Choose the folder of a training run to see its loss."),
             inks.faintText);
    return;
  }
  const Axis axis = lossAxis();
  paintAxes(painter, axis);
  paintCheckpoints(painter);
  const std::vector<Word> words = legend();
  for (const Word& word : words) {
    painter.setPen(word.ink);
    painter.drawText(word.place, Qt::AlignLeft | Qt::AlignVCenter | Qt::TextDontClip, word.text);
  }
  double LossRow::*const values[] = {&LossRow::train, &LossRow::valid, &LossRow::test};
  for (size_t i = 0; i < std::size(values); ++i)
    paintCurve(painter, axis, values[i], words[i + 1].ink);
}

render::ChartGrid LossChart::chart() const {
  if (m_run.rows.empty()) return {};
  const Axis axis = lossAxis();
  render::Chart chart{.title = tr("Loss over training steps").toStdString(),
                      .x = {.label = tr("training steps").toStdString()},
                      .y = {.label = tr("loss").toStdString(),
                            .unit = m_run.unit,
                            .range = std::pair(axis.low, axis.high)}};
  const std::tuple<QString, double LossRow::*, render::Colour> curves[] = {
      {tr("training"), &LossRow::train, render::grey(0.55)},
      {tr("validation"), &LossRow::valid, render::colourOf(0)},
      {tr("test"), &LossRow::test, render::colourOf(1)}};
  for (const auto& [name, value, colour] : curves) {
    render::Series line{.name = name.toStdString(), .colour = colour};
    for (const LossRow& row : m_run.rows) {
      line.x.push_back(static_cast<double>(row.step));
      line.y.push_back(row.*value);
    }
    const bool any =
        std::any_of(line.y.begin(), line.y.end(), [](double v) { return std::isfinite(v); });
    if (any) chart.series.push_back(std::move(line));
  }
  for (const Checkpoint& checkpoint : m_run.checkpoints)
    chart.series.push_back({.kind = render::SeriesKind::VerticalRule,
                            .name = checkpoint.name,
                            .colour = render::grey(0.6),
                            .x = {static_cast<double>(checkpoint.step)},
                            .width = 1.0,
                            .dashed = true,
                            .inLegend = false});
  return render::single(std::move(chart));
}

int LossChart::checkpointAt(const QPoint& at) const {
  int best = -1;
  double nearest = kNear;
  for (size_t i = 0; i < m_run.checkpoints.size(); ++i) {
    const double away = std::abs(xOf(m_run.checkpoints[i].step) - at.x());
    if (away <= nearest) {
      nearest = away;
      best = static_cast<int>(i);
    }
  }
  return best;
}

void LossChart::mousePressEvent(QMouseEvent* event) {
  const int index = checkpointAt(event->pos());
  if (index >= 0) Q_EMIT checkpointClicked(index);
}

bool LossChart::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  const int index = checkpointAt(help->pos());
  if (index >= 0)
    QToolTip::showText(help->globalPos(),
                       QString::fromStdString(m_run.checkpoints[static_cast<size_t>(index)].name));
  else
    QToolTip::hideText();
  return true;
}

}  // namespace marey::gui
