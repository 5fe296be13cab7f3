#include "gui/workspace/motion_labels.h"

#include <QCoreApplication>

namespace marey::gui {

QString motionLabel(const MotionGroup& group, int index) {
  const Motion& motion = group.motions.at(static_cast<size_t>(index));
  if (group.natural() && motion.clip && !motion.clip->name.empty())
    return QString::fromStdString(motion.clip->name);
  return QStringLiteral("%1, %2 %3")
      .arg(QString::fromStdString(group.name), QCoreApplication::translate("Motions", "sample"),
           QString::number(index + 1));
}

}  // namespace marey::gui
