// The numbers of the chosen way-point.
#pragma once

#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QWidget>

#include "gui/common/number_box.h"
#include "gui/common/type_box.h"
#include "gui/path/current_path.h"
#include "gui/path/path_view.h"

namespace marey::gui {

class WayPointForm : public QWidget {
  Q_OBJECT
 public:
  WayPointForm(CurrentPath& path, PathView& view, QWidget* parent);

 private:
  NumberBox* number(const char* name, const QString& suffix, double low, double high, double step,
                    const QString& toolTip);
  void build();
  void connectEdits();
  void refresh();
  /// Changes the chosen way-point, unless the form is only being filled.
  void edit(const QString& label, const std::function<void(PathEdit&, size_t)>& change);

  CurrentPath& m_path;
  PathView& m_view;
  CountBox* m_index = nullptr;
  QLabel* m_count = nullptr;
  NumberBox *m_x = nullptr, *m_z = nullptr, *m_speed = nullptr, *m_facing = nullptr,
            *m_time = nullptr;
  QCheckBox *m_ownSpeed = nullptr, *m_ownFacing = nullptr, *m_ownTime = nullptr;
  TypeBox* m_type = nullptr;
  QPushButton* m_remove = nullptr;
  bool m_filling = false;
};

}  // namespace marey::gui
