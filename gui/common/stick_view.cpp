#include "gui/common/stick_view.h"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "gui/common/paint_style.h"

#include "motion/roles.h"

namespace marey::gui {
namespace {

/// Metres from the lower to the upper edge: a person with room above and below.
constexpr double kShownM = 2.5;
constexpr double kCellM = 0.5;
constexpr int kCells = 8;

enum class Side { Middle, Left, Right };

/// The side of every joint: that of the hip or shoulder it hangs on.
std::vector<Side> sidesOf(const Skeleton& skeleton) {
  const SkeletonRoles roles = rolesOf(skeleton);
  std::vector<Side> out(skeleton.names.size(), Side::Middle);
  for (size_t j = 0; j < out.size(); ++j) {
    const int joint = static_cast<int>(j);
    if (joint == roles.leftHip || joint == roles.leftShoulder)
      out[j] = Side::Left;
    else if (joint == roles.rightHip || joint == roles.rightShoulder)
      out[j] = Side::Right;
    else if (skeleton.parents[j] >= 0)
      out[j] = out[static_cast<size_t>(skeleton.parents[j])];
  }
  return out;
}

}  // namespace

StickView::StickView(QWidget* parent) : QWidget(parent) {
  setMinimumSize(140, 160);
  setFont(readableFont(font()));
}

void StickView::setDirection(double yaw, double elevation) {
  m_yaw = yaw;
  m_elevation = elevation;
  update();
}

void StickView::setTitle(const QString& title) {
  m_title = title;
  update();
}

void StickView::setHint(const QString& hint) {
  m_hint = hint;
  update();
}

void StickView::setFigures(std::vector<StickFigure> figures) {
  m_figures = std::move(figures);
  if (!m_figures.empty() && !m_figures.front().joints.empty())
    m_centre = {m_figures.front().joints[0].x(), static_cast<float>(kShownM * 0.42),
                m_figures.front().joints[0].z()};
  update();
}

QPointF StickView::onScreen(const Vec3& world) const {
  const double scale = height() / kShownM;
  const Vec3 d = world - m_centre;
  const double c = std::cos(m_yaw), s = std::sin(m_yaw);
  const double across = c * d.x() - s * d.z(), towards = s * d.x() + c * d.z();
  const double up = std::cos(m_elevation) * d.y() - std::sin(m_elevation) * towards;
  return {width() / 2.0 + scale * across, height() / 2.0 - scale * up};
}

void StickView::paintFloor(QPainter& painter, const QColor& ink) const {
  painter.setPen(QPen(ink, 1));
  const double x0 = std::floor(m_centre.x() / kCellM) * kCellM;
  const double z0 = std::floor(m_centre.z() / kCellM) * kCellM;
  const double reach = kCells * kCellM;
  for (int i = -kCells; i <= kCells; ++i) {
    const auto at = [](double x, double z) {
      return Vec3(static_cast<float>(x), 0, static_cast<float>(z));
    };
    const double x = x0 + i * kCellM, z = z0 + i * kCellM;
    painter.drawLine(onScreen(at(x, z0 - reach)), onScreen(at(x, z0 + reach)));
    painter.drawLine(onScreen(at(x0 - reach, z)), onScreen(at(x0 + reach, z)));
  }
}

void StickView::paintFigure(QPainter& painter, const StickFigure& figure) const {
  if (!figure.skeleton || figure.joints.size() != figure.skeleton->names.size()) return;
  const bool dark = isDark(palette());
  const std::vector<Side> sides = sidesOf(*figure.skeleton);
  for (const auto& [parent, child] : figure.skeleton->bones()) {
    const Side side = sides[static_cast<size_t>(child)];
    QColor ink = figure.colour;
    if (!ink.isValid())
      ink = side == Side::Left    ? shownColour(render::colourOf(0), dark)
            : side == Side::Right ? shownColour(render::colourOf(1), dark)
                                  : palette().color(QPalette::Text);
    painter.setPen(QPen(ink, 3, Qt::SolidLine, Qt::RoundCap));
    painter.drawLine(onScreen(figure.joints[static_cast<size_t>(parent)]),
                     onScreen(figure.joints[static_cast<size_t>(child)]));
  }
}

void StickView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const Inks inks = inksOf(palette());
  painter.fillRect(rect(), inks.background);
  if (m_figures.empty()) {
    drawHint(painter, rect(), m_hint, inks.faintText);
    return;
  }
  paintFloor(painter, inks.grid);
  for (const StickFigure& figure : m_figures) paintFigure(painter, figure);
  painter.setPen(inks.faintText);
  painter.drawText(rect().adjusted(kSpacing, kSpacing, -kSpacing, -kSpacing),
                   Qt::AlignLeft | Qt::AlignTop, m_title);
}

double firstHeading(const Clip& clip) {
  const SkeletonRoles roles = rolesOf(*clip.skeleton);
  if (!roles.hasFacing() || clip.frameCount() == 0) return 0.0;
  const Vec3 left = clip.at(0, roles.leftHip) - clip.at(0, roles.rightHip);
  return std::atan2(-left.z(), left.x());
}

}  // namespace marey::gui
