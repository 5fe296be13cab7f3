#include "gui/plots/body_map.h"

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace marey::gui {
namespace {
constexpr double kMargin = 16.0, kBarHeight = 46.0;

/// Which way to look at the body: along z from the front, or along x where it is longer than high.
struct View {
  bool side = false;
  double left = 0.0, bottom = 0.0, width = 1.0, height = 1.0;

  QPointF flat(const Vec3& p) const {
    return {static_cast<double>(side ? p.z() : p.x()), static_cast<double>(p.y())};
  }
};

View viewOf(const std::vector<Vec3>& pose) {
  View view;
  if (pose.empty()) return view;
  Vec3 low = pose.front(), high = pose.front();
  for (const Vec3& p : pose) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vec3 size = high - low;
  view.side = size.z() > 1.5F * size.x() && size.z() > 0.7F * size.y();
  const QPointF least = view.flat(low), most = view.flat(high);
  view.left = least.x();
  view.bottom = least.y();
  view.width = std::max(0.05, most.x() - least.x());
  view.height = std::max(0.05, most.y() - least.y());
  return view;
}
}  // namespace

QColor mapColour(double share) {
  static constexpr std::array<std::array<int, 3>, 9> colours{{{0, 34, 78},
                                                              {27, 59, 109},
                                                              {67, 83, 108},
                                                              {98, 107, 112},
                                                              {125, 124, 120},
                                                              {155, 149, 118},
                                                              {187, 174, 107},
                                                              {220, 202, 86},
                                                              {254, 232, 56}}};
  const double at = std::clamp(share, 0.0, 1.0) * (colours.size() - 1);
  const auto i = std::min(static_cast<size_t>(at), colours.size() - 2);
  const double rest = at - static_cast<double>(i);
  const auto channel = [&](size_t c) {
    return static_cast<int>(std::lround(std::lerp(colours[i][c], colours[i + 1][c], rest)));
  };
  return {channel(0), channel(1), channel(2)};
}

BodyMap::BodyMap(QWidget* parent) : QWidget(parent) {
  setAccessibleName(tr("Body map"));
}

void BodyMap::setData(BodyMapData data) {
  m_data = std::move(data);
  update();
}

void BodyMap::setJoint(std::optional<int> joint) {
  m_joint = joint;
  update();
}

double BodyMap::highest() const {
  double most = 0.0;
  for (const double v : m_data.values)
    if (std::isfinite(v)) most = std::max(most, v);
  return most;
}

QPointF BodyMap::placeOf(int joint) const {
  const View view = viewOf(m_data.pose);
  const double roomX = width() - 2 * kMargin, roomY = height() - 2 * kMargin - kBarHeight;
  const double scale = std::min(roomX / view.width, roomY / view.height);
  const QPointF p = view.flat(m_data.pose[static_cast<size_t>(joint)]);
  return {width() / 2.0 + scale * (p.x() - view.left - view.width / 2.0),
          kMargin + roomY / 2.0 - scale * (p.y() - view.bottom - view.height / 2.0)};
}

void BodyMap::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), palette().color(QPalette::Base));
  if (!m_data.skeleton || m_data.pose.empty()) return;
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(palette().color(QPalette::Mid), 3.0, Qt::SolidLine, Qt::RoundCap));
  for (const auto& [parent, child] : m_data.skeleton->bones())
    painter.drawLine(placeOf(parent), placeOf(child));
  const double most = highest();
  for (int j = 0; j < static_cast<int>(m_data.pose.size()); ++j) {
    const auto index = static_cast<size_t>(j);
    const double value = index < m_data.values.size() ? m_data.values[index]
                                                      : std::numeric_limits<double>::quiet_NaN();
    painter.setPen(QPen(palette().color(QPalette::Text), 1.0));
    painter.setBrush(std::isfinite(value) ? mapColour(most > 0.0 ? value / most : 0.0)
                                          : palette().color(QPalette::Button));
    painter.drawEllipse(placeOf(j), 6.0, 6.0);
  }
  if (m_joint && *m_joint >= 0 && *m_joint < static_cast<int>(m_data.pose.size())) {
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(palette().color(QPalette::Highlight), 2.5));
    painter.drawEllipse(placeOf(*m_joint), 9.5, 9.5);
  }
  paintBar(painter);
}

void BodyMap::paintBar(QPainter& painter) const {
  const double most = highest();
  painter.setPen(palette().color(QPalette::Text));
  const QRectF label(4, height() - kBarHeight, width() - 8, 16);
  painter.drawText(label, Qt::AlignCenter, m_data.label);
  if (!(most > 0.0)) return;
  const QRectF bar(kMargin, height() - 28, width() - 2 * kMargin, 8);
  QLinearGradient gradient(bar.topLeft(), bar.topRight());
  for (int i = 0; i <= 8; ++i) gradient.setColorAt(i / 8.0, mapColour(i / 8.0));
  painter.fillRect(bar, gradient);
  const QRectF numbers(bar.left(), bar.bottom() + 1, bar.width(), 16);
  painter.drawText(numbers, Qt::AlignLeft, QStringLiteral("0"));
  painter.drawText(numbers, Qt::AlignRight, QString::number(most, 'g', 3));
}

render::ChartGrid BodyMap::chart() const {
  if (!m_data.skeleton || m_data.pose.empty()) return {};
  const View view = viewOf(m_data.pose);
  const double most = highest();
  // One scale for both axes: the body stands in a square.
  const double half = 0.55 * std::max(view.width, view.height);
  const double x = view.left + 0.5 * view.width, y = view.bottom + 0.5 * view.height;
  render::Chart body{.x = {.label = "across", .unit = "m", .range = std::pair(x - half, x + half)},
                     .y = {.label = "height", .unit = "m", .range = std::pair(y - half, y + half)},
                     .legend = render::LegendPlace::None};
  for (const auto& [parent, child] : m_data.skeleton->bones()) {
    const QPointF a = view.flat(m_data.pose[static_cast<size_t>(parent)]);
    const QPointF b = view.flat(m_data.pose[static_cast<size_t>(child)]);
    body.series.push_back({.name = "bone",
                           .colour = render::grey(0.7),
                           .x = {a.x(), b.x()},
                           .y = {a.y(), b.y()},
                           .width = 2.5});
  }
  render::Chart values{.x = {.label = m_data.label.toStdString()},
                       .legend = render::LegendPlace::None};
  for (size_t j = 0; j < m_data.pose.size(); ++j) {
    const double value =
        j < m_data.values.size() ? m_data.values[j] : std::numeric_limits<double>::quiet_NaN();
    const QColor ink = mapColour(most > 0.0 && std::isfinite(value) ? value / most : 0.0);
    const render::Colour colour = std::isfinite(value)
                                      ? render::Colour{ink.redF(), ink.greenF(), ink.blueF(), 1.0}
                                      : render::grey(0.7);
    const std::string& name = m_data.skeleton->names[j];
    const QPointF at = view.flat(m_data.pose[j]);
    body.series.push_back({.kind = render::SeriesKind::Dots,
                           .name = name,
                           .colour = colour,
                           .x = {at.x()},
                           .y = {at.y()}});
    values.y.categories.push_back(name);
    if (std::isfinite(value))
      values.series.push_back({.kind = render::SeriesKind::Intervals,
                               .name = name,
                               .colour = colour,
                               .y = {static_cast<double>(j) + 0.5},
                               .low = {0.0},
                               .high = {value},
                               .width = 0.62});
  }
  render::ChartGrid grid{.charts = {std::move(body)}, .columns = 2};
  if (!values.series.empty()) grid.charts.push_back(std::move(values));
  return grid;
}

int BodyMap::jointAt(const QPoint& at) const {
  int nearest = -1;
  double least = 14.0;
  for (int j = 0; j < static_cast<int>(m_data.pose.size()); ++j) {
    const QPointF p = placeOf(j) - at;
    const double distance = std::hypot(p.x(), p.y());
    if (distance >= least) continue;
    nearest = j;
    least = distance;
  }
  return nearest;
}

void BodyMap::mousePressEvent(QMouseEvent* event) {
  const int joint = jointAt(event->pos());
  if (joint >= 0) Q_EMIT jointClicked(joint);
}

bool BodyMap::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  const int joint = jointAt(help->pos());
  if (joint < 0) {
    QToolTip::hideText();
    return true;
  }
  const auto index = static_cast<size_t>(joint);
  QString text = QString::fromStdString(m_data.skeleton->names[index]);
  if (index < m_data.values.size() && std::isfinite(m_data.values[index]))
    text += QStringLiteral(": %1").arg(m_data.values[index], 0, 'g', 3);
  QToolTip::showText(help->globalPos(), text, this);
  return true;
}

}  // namespace marey::gui
