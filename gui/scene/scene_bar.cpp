#include "gui/scene/scene_bar.h"

#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QWidgetAction>
#include <algorithm>

#include "gui/common/number_box.h"
#include "gui/common/paint_style.h"

namespace marey::gui {
namespace {

QString withKeys(const QString& toolTip, const QList<QKeySequence>& keys) {
  if (keys.isEmpty()) return toolTip;
  QStringList names;
  for (const QKeySequence& key : keys) names << key.toString(QKeySequence::NativeText);
  return QStringLiteral("%1 (%2)").arg(toolTip, names.join(QStringLiteral(", ")));
}

}  // namespace

SceneBar::SceneBar(SceneView& view, QWidget* shortcutOwner, QWidget* parent)
    : QWidget(parent), m_view(view), m_owner(shortcutOwner) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(kMargin, 4, kMargin, 4);
  layout->setSpacing(kSpacing);
  m_colour = addChoice(QStringLiteral("sceneColourBy"), tr("What the colours mean"),
                       {tr("By system"), tr("By sample"), tr("By log-likelihood"), tr("By speed")});
  m_naturalUnder = addChoice(QStringLiteral("sceneNaturalUnder"),
                             tr("The model under which natural motion is scored"), {});
  m_placement = addChoice(
      QStringLiteral("scenePlacement"),
      tr("Where the motions are: where they walk, all in their own root frame, or moved apart"),
      {tr("World"), tr("Root-aligned"), tr("Side by side")});
  buildViewMenu();
  buildShowMenu();
  m_follow = addToggle(QStringLiteral("sceneFollow"), tr("Follow"),
                       tr("The camera moves along with the chosen motions, or with all"), {},
                       [this](bool on) { m_view.setFollow(on); });
  m_edit = addToggle(QStringLiteral("sceneEditPath"), tr("Edit path"),
                     tr("Drag the way-points of the current path on the floor"), {Qt::Key_E},
                     [this](bool on) {
                       if (on) m_placement->setCurrentIndex(0);  // elsewhere the path has no place
                       if (on) m_path->setChecked(true);
                       m_view.setPathEditing(on);
                     });
  layout->addStretch(1);
  auto* remove = new QAction(tr("Remove way-point"), m_owner);
  remove->setObjectName(QStringLiteral("sceneRemoveWayPoint"));
  remove->setShortcut(QKeySequence::Delete);
  remove->setShortcutContext(Qt::WidgetWithChildrenShortcut);
  connect(remove, &QAction::triggered, this, [this] { m_view.removeWayPoint(); });
  m_owner->addAction(remove);
  connect(m_placement, qOverload<int>(&QComboBox::currentIndexChanged), this, [this](int index) {
    if (index != 0) m_edit->setChecked(false);
    apply();
  });
  connect(m_colour, qOverload<int>(&QComboBox::currentIndexChanged), this, &SceneBar::apply);
  connect(m_naturalUnder, qOverload<int>(&QComboBox::activated), this, &SceneBar::apply);
  connect(&m_view, &SceneView::settingsReplaced, this, [this] {
    const QSignalBlocker quiet(m_placement);
    m_placement->setCurrentIndex(static_cast<int>(m_view.settings().placement));
  });
  connect(&m_view.workspace().document(), &Document::changed, this, &SceneBar::refreshSystems);
  refreshSystems();
  connectView();
}

/// A choice of models matters only where there are several and likelihood is shown.
void SceneBar::refreshSystems() {
  const QString before = m_naturalUnder->currentText();
  m_naturalUnder->clear();
  for (const ExperimentSystem& system : m_view.workspace().document().experiment().systems)
    m_naturalUnder->addItem(QString::fromStdString(system.name));
  m_naturalUnder->setCurrentIndex(std::max(0, m_naturalUnder->findText(before)));
  m_naturalUnder->setVisible(m_naturalUnder->count() > 1 &&
                             m_colour->currentIndex() == static_cast<int>(ColourBy::Likelihood));
}

QComboBox* SceneBar::addChoice(const QString& name, const QString& toolTip,
                               const QStringList& items) {
  auto* box = new QComboBox(this);
  box->setObjectName(name);
  box->setToolTip(toolTip);
  box->setAccessibleName(toolTip);
  box->addItems(items);
  box->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  layout()->addWidget(box);
  return box;
}

QToolButton* SceneBar::addMenu(const QString& name, const QString& text, const QString& toolTip) {
  auto* button = new QToolButton(this);
  button->setObjectName(name);
  button->setText(text);
  button->setToolTip(toolTip);
  button->setPopupMode(QToolButton::InstantPopup);
  button->setAutoRaise(true);
  button->setMenu(new QMenu(button));
  layout()->addWidget(button);
  return button;
}

QToolButton* SceneBar::addToggle(const QString& name, const QString& text, const QString& toolTip,
                                 const QList<QKeySequence>& keys,
                                 const std::function<void(bool)>& set) {
  auto* button = new QToolButton(this);
  button->setObjectName(name);
  button->setText(text);
  button->setToolTip(withKeys(toolTip, keys));
  button->setCheckable(true);
  button->setAutoRaise(true);
  connect(button, &QToolButton::toggled, this, set);
  layout()->addWidget(button);
  if (!keys.isEmpty()) addAction(nullptr, name + "Key", text, keys, [button] { button->toggle(); });
  return button;
}

QAction* SceneBar::addAction(QMenu* menu, const QString& name, const QString& text,
                             const QList<QKeySequence>& keys, const std::function<void()>& run) {
  auto* action = new QAction(text, m_owner);
  action->setObjectName(name);
  action->setShortcuts(keys);
  // Single letters must not act while somebody types in another panel.
  action->setShortcutContext(Qt::WidgetWithChildrenShortcut);
  connect(action, &QAction::triggered, this, run);
  m_owner->addAction(action);
  if (menu) menu->addAction(action);
  return action;
}

void SceneBar::buildViewMenu() {
  QMenu* menu = addMenu(QStringLiteral("sceneViewMenu"), tr("View"),
                        tr("Camera: left drag turns, middle or Shift drag shifts, wheel zooms"))
                    ->menu();
  struct Preset {
    const char* name;
    QString text;
    QList<QKeySequence> keys;
    render::View view;
  };
  const std::vector<Preset> presets = {
      {"sceneViewThreeQuarter", tr("Three-quarter"), {Qt::Key_0}, render::View::ThreeQuarter},
      {"sceneViewSide", tr("Side"), {Qt::Key_1}, render::View::Side},
      {"sceneViewFront", tr("Front"), {Qt::Key_3}, render::View::Front},
      {"sceneViewBack", tr("Back"), {Qt::Key_9}, render::View::Back},
      {"sceneViewTop", tr("Top"), {Qt::Key_7}, render::View::Top}};
  for (const Preset& preset : presets)
    addAction(menu, QLatin1String(preset.name), preset.text, preset.keys,
              [this, view = preset.view] { m_view.setView(view); });
  menu->addSeparator();
  m_flat = addAction(menu, QStringLiteral("sceneOrthographic"), tr("Orthographic"),
                     {Qt::Key_5, Qt::Key_O}, [] {});
  m_flat->setCheckable(true);
  connect(m_flat, &QAction::toggled, this, [this](bool on) { m_view.setOrthographic(on); });
  addAction(menu, QStringLiteral("sceneFit"), tr("Fit everything"), {Qt::Key_F, Qt::Key_X},
            [this] { m_view.fit(); });
  buildCameraSlots(menu);
}

void SceneBar::buildShowMenu() {
  QMenu* menu =
      addMenu(QStringLiteral("sceneShowMenu"), tr("Show"), tr("How figures and floor are drawn"))
          ->menu();
  auto* holder = new QWidgetAction(menu);
  holder->setDefaultWidget(showForm(menu));
  menu->addAction(holder);
  addAction(nullptr, QStringLiteral("sceneShadowKey"), tr("Shadow"), {Qt::Key_S},
            [this] { m_shadow->toggle(); });
}

QWidget* SceneBar::showForm(QWidget* parent) {
  auto* form = new QWidget(parent);
  auto* rows = new QFormLayout(form);
  rows->setContentsMargins(kMargin, kMargin, kMargin, kMargin);
  const auto choice = [&](const char* name, const QString& label, const QStringList& items) {
    auto* box = new QComboBox(form);
    box->setObjectName(QLatin1String(name));
    box->addItems(items);
    rows->addRow(label, box);
    connect(box, qOverload<int>(&QComboBox::currentIndexChanged), this, &SceneBar::apply);
    return box;
  };
  const auto check = [&](const char* name, const QString& label, bool on) {
    auto* box = new QCheckBox(label, form);
    box->setObjectName(QLatin1String(name));
    box->setChecked(on);
    rows->addRow(QString(), box);
    connect(box, &QCheckBox::toggled, this, &SceneBar::apply);
    return box;
  };
  m_detail = choice("sceneDetail", tr("Detail"), {tr("Automatic"), tr("Capsules"), tr("Lines")});
  m_opacity = new QSlider(Qt::Horizontal, form);
  m_opacity->setObjectName(QStringLiteral("sceneOpacity"));
  m_opacity->setRange(5, 100);
  m_opacity->setValue(100);
  m_opacity->setToolTip(tr("Opacity of motions, 5 to 100 %"));
  connect(m_opacity, &QSlider::valueChanged, this, &SceneBar::apply);
  rows->addRow(tr("Opacity"), m_opacity);
  m_ghosts = addSeconds(form, "sceneGhosts", 0.0, 100.0, 0.0);
  m_ghosts->setSpecialValueText(tr("off"));
  m_ghosts->setToolTip(tr("Paler figures at this distance in time, as on Marey's plates"));
  m_ghostUnit = new QComboBox(form);
  m_ghostUnit->setObjectName(QStringLiteral("sceneGhostUnit"));
  m_ghostUnit->addItems({tr("seconds"), tr("frames")});
  connect(m_ghostUnit, qOverload<int>(&QComboBox::currentIndexChanged), this, [this](int frames) {
    m_ghosts->setDecimals(frames ? 0 : 2);
    m_ghosts->setSingleStep(frames ? 1.0 : 0.25);
    apply();
  });
  auto* ghosts = new QHBoxLayout;
  ghosts->addWidget(m_ghosts);
  ghosts->addWidget(m_ghostUnit);
  rows->addRow(tr("Ghosts every"), ghosts);
  m_trails = choice("sceneTrails", tr("Trails"), {tr("Off"), tr("Selected joint"), tr("Feet")});
  m_trailS = addSeconds(form, "sceneTrailLength", 0.25, 60.0, 1.0);
  m_trailS->setSuffix(tr(" s"));
  m_trailS->setToolTip(tr("How long ago a trail begins"));
  rows->addRow(tr("Trail length"), m_trailS);
  m_contacts = check("sceneContacts", tr("Foot contacts on the floor"), false);
  m_shadow = check("sceneShadow", tr("Shadow (S)"), true);
  m_path = check("scenePath", tr("Current path"), true);
  return form;
}

QDoubleSpinBox* SceneBar::addSeconds(QWidget* form, const char* name, double low, double high,
                                     double value) {
  auto* box = new NumberBox(form);
  box->setObjectName(QLatin1String(name));
  box->setRange(low, high);
  box->setSingleStep(0.25);
  box->setValue(value);
  connect(box, qOverload<double>(&QDoubleSpinBox::valueChanged), this, &SceneBar::apply);
  return box;
}

void SceneBar::apply() {
  m_naturalUnder->setVisible(m_naturalUnder->count() > 1 &&
                             m_colour->currentIndex() == static_cast<int>(ColourBy::Likelihood));
  SceneSettings settings;
  settings.colourBy = static_cast<ColourBy>(m_colour->currentIndex());
  settings.placement = static_cast<render::Placement>(m_placement->currentIndex());
  settings.detail = static_cast<render::BodyDetail>(m_detail->currentIndex());
  settings.opacity = m_opacity->value() / 100.0;
  if (m_ghostUnit->currentIndex() == 1)
    settings.ghostFrames = static_cast<int>(m_ghosts->value());
  else
    settings.ghostsS = m_ghosts->value();
  settings.trailS = m_trailS->value();
  settings.naturalUnder = m_naturalUnder->currentText().toStdString();
  settings.trails = static_cast<Trails>(m_trails->currentIndex());
  settings.contacts = m_contacts->isChecked();
  settings.shadow = m_shadow->isChecked();
  settings.path = m_path->isChecked();
  m_view.setSettings(settings);
}

}  // namespace marey::gui
