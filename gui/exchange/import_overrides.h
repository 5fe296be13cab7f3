// How a file is to be read where it, or the doctor, says something else.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QGroupBox>
#include <QPushButton>

#include "io/format.h"

namespace marey::gui {

class ImportOverrides : public QGroupBox {
  Q_OBJECT
 public:
  explicit ImportOverrides(QWidget* parent);

  void setOptions(const io::ReadOptions& options);
  /// What is set, over what the last options hold beside that.
  io::ReadOptions options() const;
  void setSeveral(bool several) { m_all->setEnabled(several); }

 Q_SIGNALS:
  void changed();
  void forAll();

 private:
  io::ReadOptions m_options;
  QComboBox* m_unit;
  QComboBox* m_up;
  QComboBox* m_euler;
  QDoubleSpinBox* m_fps;
  QCheckBox* m_swap;
  QPushButton* m_all;
};

}  // namespace marey::gui
