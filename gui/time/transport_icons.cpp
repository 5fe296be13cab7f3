#include "gui/time/transport_icons.h"

#include <QPainter>
#include <QPixmap>

namespace marey::gui {
namespace {

constexpr int kSide = 64;  ///< drawn large, shown smaller on any screen

/// A triangle whose tip points right, between two columns.
QPolygonF triangle(double left, double right) {
  return QPolygonF({QPointF(left, 12), QPointF(right, 32), QPointF(left, 52)});
}

void drawForward(QPainter& painter, Transport sign) {
  if (sign == Transport::Play) painter.drawPolygon(triangle(16, 52));
  if (sign == Transport::Pause) {
    painter.drawRect(QRectF(16, 12, 11, 40));
    painter.drawRect(QRectF(37, 12, 11, 40));
  }
  if (sign == Transport::Forward || sign == Transport::Back) {
    painter.drawRect(QRectF(14, 12, 8, 40));
    painter.drawPolygon(triangle(28, 54));
  }
  if (sign == Transport::End || sign == Transport::Start) {
    painter.drawPolygon(triangle(12, 42));
    painter.drawRect(QRectF(44, 12, 8, 40));
  }
}

QPixmap picture(Transport sign, const QColor& ink) {
  QPixmap out(kSide, kSide);
  out.fill(Qt::transparent);
  QPainter painter(&out);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  painter.setBrush(ink);
  if (sign == Transport::Back || sign == Transport::Start) {
    painter.translate(kSide, 0);
    painter.scale(-1, 1);
  }
  drawForward(painter, sign);
  return out;
}

}  // namespace

QIcon transportIcon(Transport sign, const QColor& ink) {
  QIcon out(picture(sign, ink));
  QColor faint = ink;
  faint.setAlphaF(0.35);
  out.addPixmap(picture(sign, faint), QIcon::Disabled);
  return out;
}

}  // namespace marey::gui
