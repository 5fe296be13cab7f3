#include "gui/exchange/import_overrides.h"

#include <QFormLayout>

#include "gui/common/number_box.h"

#include "io/units.h"

namespace marey::gui {

ImportOverrides::ImportOverrides(QWidget* parent)
    : QGroupBox(tr("Read this file as"), parent),
      m_unit(new QComboBox(this)),
      m_up(new QComboBox(this)),
      m_euler(new QComboBox(this)),
      m_fps(new NumberBox(this)),
      m_swap(new QCheckBox(tr("Left and right are swapped"), this)),
      m_all(new QPushButton(tr("Use for all files"), this)) {
  const auto choice = [this](QComboBox* box, const char* name) {
    box->setObjectName(QLatin1String(name));
    box->addItem(tr("as found"), QString());
    connect(box, qOverload<int>(&QComboBox::activated), this, &ImportOverrides::changed);
  };
  choice(m_unit, "importUnit");
  for (const io::LengthUnit& unit : io::lengthUnits()) {
    const QString name = QString::fromStdString(unit.name);
    m_unit->addItem(name, name);
  }
  choice(m_up, "importUp");
  for (const QString& axis : {QStringLiteral("y"), QStringLiteral("z")}) m_up->addItem(axis, axis);
  choice(m_euler, "importEuler");
  m_euler->setToolTip(
      tr("Order in which the turns of BVH and AMC files are put together; their values keep their "
         "axes. Files without Euler angles are read as before."));
  for (const char* order : {"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"})
    m_euler->addItem(QLatin1String(order), QLatin1String(order));
  m_fps->setObjectName(QStringLiteral("importFps"));
  m_fps->setRange(0.0, 1000.0);
  m_fps->setDecimals(3);
  m_fps->setSpecialValueText(tr("as found"));
  m_swap->setObjectName(QStringLiteral("importSwap"));
  m_all->setObjectName(QStringLiteral("importForAll"));
  auto* form = new QFormLayout(this);
  form->addRow(tr("Unit"), m_unit);
  form->addRow(tr("Up axis"), m_up);
  form->addRow(tr("Euler order"), m_euler);
  form->addRow(tr("Frames per second"), m_fps);
  form->addRow(tr("Sides"), m_swap);
  form->addRow({}, m_all);
  connect(m_fps, &QDoubleSpinBox::editingFinished, this, [this] {
    // Leaving the field untouched is no change.
    if (m_fps->value() != m_options.fps.value_or(0.0)) Q_EMIT changed();
  });
  connect(m_swap, &QCheckBox::clicked, this, &ImportOverrides::changed);
  connect(m_all, &QPushButton::clicked, this, &ImportOverrides::forAll);
}

void ImportOverrides::setOptions(const io::ReadOptions& options) {
  m_options = options;
  m_unit->setCurrentIndex(m_unit->findData(QString::fromStdString(options.unit)));
  m_up->setCurrentIndex(m_up->findData(QString::fromStdString(options.up)));
  m_euler->setCurrentIndex(m_euler->findData(QString::fromStdString(options.eulerOrder)));
  m_fps->setValue(options.fps.value_or(0.0));
  m_swap->setChecked(options.swapSides);
}

io::ReadOptions ImportOverrides::options() const {
  io::ReadOptions out = m_options;
  out.unit = m_unit->currentData().toString().toStdString();
  out.up = m_up->currentData().toString().toStdString();
  out.eulerOrder = m_euler->currentData().toString().toStdString();
  out.fps.reset();
  if (m_fps->value() > 0.0) out.fps = m_fps->value();
  out.swapSides = m_swap->isChecked();
  return out;
}

}  // namespace marey::gui
