// What steers a live session: arrow keys, a pad for the mouse, and how far they reach.
#pragma once

#include <QDoubleSpinBox>
#include <QKeyEvent>
#include <QWidget>
#include <set>
#include <string>
#include <vector>

#include "gui/common/type_box.h"
#include "task/live_rollout.h"

namespace marey::gui {

class LiveControls : public QWidget {
  Q_OBJECT
 public:
  explicit LiveControls(QWidget* parent);

  /// What the held keys ask for.
  LiveCommand command() const;
  /// What full deflections of a gamepad ask for.
  LiveCommand fullDeflection() const;
  /// Arrow keys steer while a session runs, wherever the focus is but where they edit something.
  void setSteering(bool steering);
  void releaseAll();
  /// The types that there are to choose from: shown where there are any, keys 1 to 9 choose.
  void setTypes(std::vector<std::string> types);

 Q_SIGNALS:
  void changed();

 protected:
  bool eventFilter(QObject* object, QEvent* event) override;

 private:
  QDoubleSpinBox* number(const char* name, double value, double low, double high,
                         const QString& unit);
  void addPad();
  void take(const QKeyEvent& event, bool down);
  bool chooseType(int key);

  QDoubleSpinBox *m_speed = nullptr, *m_sideways = nullptr, *m_turn = nullptr, *m_facing = nullptr;
  TypeBox* m_type = nullptr;
  QWidget* m_typeLabel = nullptr;
  std::vector<std::string> m_types;
  std::set<int> m_keys;  ///< held down
  bool m_shift = false, m_control = false, m_steering = false;
};

}  // namespace marey::gui
