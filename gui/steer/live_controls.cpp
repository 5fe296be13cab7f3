#include "gui/steer/live_controls.h"

#include <QApplication>
#include <QFormLayout>
#include <QGridLayout>
#include <QToolButton>
#include <QVBoxLayout>
#include <numbers>

#include "gui/common/number_box.h"

namespace marey::gui {
namespace {
constexpr double kRadians = std::numbers::pi / 180.0;
/// Of the body while a key for it is held, and of a pad's stick.
constexpr double kLookAside = std::numbers::pi / 2.0;

bool steers(int key) {
  return key == Qt::Key_Up || key == Qt::Key_Down || key == Qt::Key_Left || key == Qt::Key_Right;
}

bool edits(const QWidget* focus) {
  for (const char* editor : {"QLineEdit", "QTextEdit", "QPlainTextEdit", "QAbstractSpinBox",
                             "QComboBox", "QAbstractItemView", "QAbstractSlider", "QMenu"})
    if (focus != nullptr && focus->inherits(editor)) return true;
  return false;
}
}  // namespace

LiveControls::LiveControls(QWidget* parent) : QWidget(parent) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* form = new QFormLayout;
  m_speed = number("liveSpeed", 1.2, 0.0, 4.0, tr(" m/s"));
  m_sideways = number("liveSideways", 0.5, 0.0, 4.0, tr(" m/s"));
  m_turn = number("liveTurn", 60.0, 0.0, 360.0, tr(" °/s"));
  m_facing = number("liveFacing", 0.0, -180.0, 180.0, tr("°"));
  m_facing->setToolTip(
      tr("Where the body looks, to the left of its way; Ctrl+Left and Ctrl+Right look aside"));
  form->addRow(tr("Speed"), m_speed);
  form->addRow(tr("Sideways"), m_sideways);
  form->addRow(tr("Turn"), m_turn);
  form->addRow(tr("Facing"), m_facing);
  m_type = new TypeBox("liveType", tr("Type of motion; keys 1 to 9 choose while steering"),
                       tr("the model's first"), this);
  form->addRow(tr("Type"), m_type);
  m_typeLabel = form->labelForField(m_type);
  connect(m_type, &TypeBox::typeChosen, this, [this] { Q_EMIT changed(); });
  layout->addLayout(form);
  addPad();
  setTypes({});
}

void LiveControls::setTypes(std::vector<std::string> types) {
  m_types = std::move(types);
  m_type->display(m_types, m_type->chosen());
  m_type->setVisible(!m_types.empty());
  m_typeLabel->setVisible(!m_types.empty());
}

QDoubleSpinBox* LiveControls::number(const char* name, double value, double low, double high,
                                     const QString& unit) {
  auto* box = new NumberBox(this);
  box->setObjectName(QLatin1String(name));
  box->setRange(low, high);
  box->setSingleStep((high - low) / 40.0);
  box->setValue(value);
  box->setSuffix(unit);
  connect(box, qOverload<double>(&QDoubleSpinBox::valueChanged), this,
          [this] { Q_EMIT changed(); });
  return box;
}

/// Arrows for the mouse, and sideways in the lower corners.
void LiveControls::addPad() {
  auto* grid = new QGridLayout;
  struct Button {
    const char* name;
    QString text, tip;
    int row, column, key;
    bool shift;
  };
  const Button buttons[] = {
      {"livePadUp", QStringLiteral("▲"), tr("Forward"), 0, 1, Qt::Key_Up, false},
      {"livePadLeft", QStringLiteral("↶"), tr("Turn left"), 1, 0, Qt::Key_Left, false},
      {"livePadDown", QStringLiteral("▼"), tr("Backward"), 1, 1, Qt::Key_Down, false},
      {"livePadRight", QStringLiteral("↷"), tr("Turn right"), 1, 2, Qt::Key_Right, false},
      {"livePadSideLeft", QStringLiteral("◀"), tr("Sideways left"), 2, 0, Qt::Key_Left, true},
      {"livePadSideRight", QStringLiteral("▶"), tr("Sideways right"), 2, 2, Qt::Key_Right, true}};
  for (const Button& b : buttons) {
    auto* button = new QToolButton(this);
    button->setObjectName(QLatin1String(b.name));
    button->setText(b.text);
    button->setToolTip(b.tip);
    button->setAccessibleName(b.tip);
    button->setFocusPolicy(Qt::NoFocus);
    button->setMinimumSize(34, 24);
    grid->addWidget(button, b.row, b.column);
    connect(button, &QToolButton::pressed, this, [this, key = b.key, shift = b.shift] {
      m_keys.insert(key);
      m_shift = shift;
      Q_EMIT changed();
    });
    connect(button, &QToolButton::released, this, [this, key = b.key] {
      m_keys.erase(key);
      m_shift = false;
      Q_EMIT changed();
    });
  }
  static_cast<QVBoxLayout*>(layout())->addLayout(grid);
}

LiveCommand LiveControls::command() const {
  const auto held = [this](int key) { return m_keys.contains(key) ? 1.0 : 0.0; };
  const double left = held(Qt::Key_Left) - held(Qt::Key_Right);
  LiveCommand out;
  out.forwardMS = (held(Qt::Key_Up) - held(Qt::Key_Down)) * m_speed->value();
  out.facingRad = m_facing->value() * kRadians;
  out.type = m_type->chosen();
  if (m_control)
    out.facingRad += left * kLookAside;
  else if (m_shift)
    out.sidewaysMS = left * m_sideways->value();
  else
    out.turnRadS = left * m_turn->value() * kRadians;
  return out;
}

LiveCommand LiveControls::fullDeflection() const {
  return {.forwardMS = m_speed->value(),
          .sidewaysMS = 0.0,
          .turnRadS = m_turn->value() * kRadians,
          .facingRad = kLookAside};
}

void LiveControls::setSteering(bool steering) {
  if (steering == m_steering) return;
  m_steering = steering;
  releaseAll();
  if (steering)
    qApp->installEventFilter(this);
  else
    qApp->removeEventFilter(this);
}

void LiveControls::releaseAll() {
  m_keys.clear();
  m_shift = m_control = false;
  Q_EMIT changed();
}

/// Keys 1 to 9.
bool LiveControls::chooseType(int key) {
  const int index = key - Qt::Key_1;
  if (index < 0 || index > 8 || index >= static_cast<int>(m_types.size())) return false;
  m_type->display(m_types, m_types[static_cast<size_t>(index)]);
  Q_EMIT changed();
  return true;
}

void LiveControls::take(const QKeyEvent& event, bool down) {
  if (event.isAutoRepeat()) return;
  if (steers(event.key()))
    down ? void(m_keys.insert(event.key())) : void(m_keys.erase(event.key()));
  // The modifiers of an event are those before it.
  if (event.key() == Qt::Key_Shift) m_shift = down;
  if (event.key() == Qt::Key_Control) m_control = down;
  if (steers(event.key())) {
    m_shift = event.modifiers().testFlag(Qt::ShiftModifier);
    m_control = event.modifiers().testFlag(Qt::ControlModifier);
  }
  Q_EMIT changed();
}

bool LiveControls::eventFilter(QObject* object, QEvent* event) {
  // Keys that go to another program are released there.
  if (event->type() == QEvent::ApplicationDeactivate) releaseAll();
  const bool press = event->type() == QEvent::KeyPress;
  const bool release = event->type() == QEvent::KeyRelease;
  const bool shortcut = event->type() == QEvent::ShortcutOverride;
  const auto* widget = qobject_cast<QWidget*>(object);
  if ((!press && !release && !shortcut) || widget == nullptr) return false;
  const auto& key = *static_cast<QKeyEvent*>(event);
  if (press && !edits(widget) && chooseType(key.key())) return true;
  const bool modifier = key.key() == Qt::Key_Shift || key.key() == Qt::Key_Control;
  if ((!steers(key.key()) && !modifier) || (press && edits(widget))) return false;
  if (shortcut) {
    // Else the key would be a command of the window (frame by frame).
    if (steers(key.key()) && !edits(widget)) event->accept();
    return steers(key.key()) && !edits(widget);
  }
  take(key, press);
  return steers(key.key()) && !edits(widget);
}

}  // namespace marey::gui
