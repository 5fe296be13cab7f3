// The slim bar above the 3D view: what is drawn and from where.
#pragma once

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QMenu>
#include <QSlider>
#include <QToolButton>
#include <functional>
#include <map>

#include "gui/scene/scene_view.h"

namespace marey::gui {

/// Its actions' keys work while the view or the bar has the focus.
class SceneBar : public QWidget {
  Q_OBJECT
 public:
  SceneBar(SceneView& view, QWidget* shortcutOwner, QWidget* parent);

 private:
  QComboBox* addChoice(const QString& name, const QString& toolTip, const QStringList& items);
  QToolButton* addMenu(const QString& name, const QString& text, const QString& toolTip);
  QToolButton* addToggle(const QString& name, const QString& text, const QString& toolTip,
                         const QList<QKeySequence>& keys, const std::function<void(bool)>& set);
  QAction* addAction(QMenu* menu, const QString& name, const QString& text,
                     const QList<QKeySequence>& keys, const std::function<void()>& run);
  void buildViewMenu();
  void buildCameraSlots(QMenu* menu);
  // scene_bar_view.cpp
  void connectView();
  SceneLook look() const;
  void setLook(const SceneLook& look);
  void saveCamera(int slot);
  void loadCamera(int slot);
  void buildShowMenu();
  QWidget* showForm(QWidget* parent);
  QDoubleSpinBox* addSeconds(QWidget* form, const char* name, double low, double high,
                             double value);
  void refreshSystems();
  void apply();

  SceneView& m_view;
  QWidget* m_owner;
  QComboBox *m_colour = nullptr, *m_placement = nullptr, *m_detail = nullptr, *m_trails = nullptr;
  QComboBox *m_naturalUnder = nullptr, *m_ghostUnit = nullptr;
  QDoubleSpinBox *m_ghosts = nullptr, *m_trailS = nullptr;
  QSlider* m_opacity = nullptr;
  QCheckBox *m_contacts = nullptr, *m_shadow = nullptr, *m_path = nullptr;
  QToolButton *m_edit = nullptr, *m_follow = nullptr;
  QAction* m_flat = nullptr;
  std::map<int, CameraPose> m_cameras;  ///< by slot
};

}  // namespace marey::gui
