// What the bar over the scene keeps in a document, and the slots of its camera.
#include <QSignalBlocker>
#include <algorithm>
#include <cmath>

#include "gui/scene/scene_bar.h"

namespace marey::gui {

void SceneBar::connectView() {
  Workspace& workspace = m_view.workspace();
  connect(&workspace, &Workspace::viewAsked, this, [this](ViewState& view) {
    view.scene = look();
    if (m_view.cameraChosen()) view.camera = m_view.camera();
    view.follow = m_follow->isChecked();
    view.cameras = m_cameras;
  });
  connect(&workspace, &Workspace::viewOpened, this, [this](const ViewState& view) {
    m_cameras = view.cameras;
    setLook(view.scene);
    const bool flat = view.camera && view.camera->orthographic;
    m_flat->setChecked(flat);
    m_follow->setChecked(view.follow);
    m_view.releaseCamera();
    if (view.camera) m_view.setCamera(*view.camera);
  });
}

SceneLook SceneBar::look() const {
  const SceneSettings& s = m_view.settings();
  return {.colourBy = static_cast<int>(s.colourBy),
          .placement = static_cast<int>(s.placement),
          .detail = static_cast<int>(s.detail),
          .trails = static_cast<int>(s.trails),
          .opacity = s.opacity,
          .ghostsS = s.ghostsS,
          .ghostFrames = s.ghostFrames,
          .trailS = s.trailS,
          // Before there is anything to choose from, nothing was chosen.
          .naturalUnder = m_naturalUnder->currentIndex() > 0 ? s.naturalUnder : std::string(),
          .contacts = s.contacts,
          .shadow = s.shadow,
          .path = s.path};
}

void SceneBar::setLook(const SceneLook& look) {
  const auto set = [](auto* widget, auto&& change) {
    const QSignalBlocker quiet(widget);
    change();
  };
  set(m_colour, [&] { m_colour->setCurrentIndex(look.colourBy); });
  set(m_placement, [&] { m_placement->setCurrentIndex(look.placement); });
  set(m_detail, [&] { m_detail->setCurrentIndex(look.detail); });
  set(m_trails, [&] { m_trails->setCurrentIndex(look.trails); });
  set(m_opacity, [&] { m_opacity->setValue(static_cast<int>(std::lround(100.0 * look.opacity))); });
  const bool frames = look.ghostFrames > 0;
  set(m_ghostUnit, [&] { m_ghostUnit->setCurrentIndex(frames ? 1 : 0); });
  set(m_ghosts, [&] {
    m_ghosts->setDecimals(frames ? 0 : 2);
    m_ghosts->setSingleStep(frames ? 1.0 : 0.25);
    m_ghosts->setValue(frames ? look.ghostFrames : look.ghostsS);
  });
  set(m_trailS, [&] { m_trailS->setValue(look.trailS); });
  set(m_contacts, [&] { m_contacts->setChecked(look.contacts); });
  set(m_shadow, [&] { m_shadow->setChecked(look.shadow); });
  set(m_path, [&] { m_path->setChecked(look.path); });
  const int system = m_naturalUnder->findText(QString::fromStdString(look.naturalUnder));
  m_naturalUnder->setCurrentIndex(std::max(0, system));
  if (look.placement != 0) m_edit->setChecked(false);
  apply();
}

void SceneBar::buildCameraSlots(QMenu* menu) {
  constexpr int kSlots = 4;
  menu->addSeparator();
  QMenu* save = menu->addMenu(tr("Save the camera"));
  QMenu* load = menu->addMenu(tr("Back to a saved camera"));
  for (int slot = 1; slot <= kSlots; ++slot) {
    const QString number = QString::number(slot);
    QList<QKeySequence> saveKeys, loadKeys;
    if (slot == 1) saveKeys = {Qt::Key_C};
    if (slot == 1) loadKeys = {Qt::Key_L};
    addAction(save, QStringLiteral("sceneSaveCamera") + number, tr("Save camera %1").arg(slot),
              saveKeys, [this, slot] { saveCamera(slot); });
    QAction* back =
        addAction(load, QStringLiteral("sceneLoadCamera") + number, tr("Go to camera %1").arg(slot),
                  loadKeys, [this, slot] { loadCamera(slot); });
    connect(load, &QMenu::aboutToShow, back,
            [this, back, slot] { back->setEnabled(m_cameras.contains(slot)); });
    connect(load, &QMenu::aboutToHide, back, [back] { back->setEnabled(true); });
  }
}

void SceneBar::saveCamera(int slot) {
  m_cameras[slot] = m_view.camera();
  Q_EMIT m_view.workspace().noticed(tr("Camera %1 saved; the document keeps it").arg(slot));
}

void SceneBar::loadCamera(int slot) {
  const auto found = m_cameras.find(slot);
  if (found == m_cameras.end()) {
    Q_EMIT m_view.workspace().noticed(tr("No camera %1 has been saved").arg(slot));
    return;
  }
  const CameraPose pose = found->second;
  m_flat->setChecked(pose.orthographic);
  m_follow->setChecked(false);
  m_view.setCamera(pose);
}

}  // namespace marey::gui
