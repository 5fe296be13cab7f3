#include "gui/document/option_form.h"

#include <QCheckBox>
#include <QSignalBlocker>
#include <algorithm>

#include "gui/common/number_box.h"

namespace marey::gui {
namespace {

/// A box of numbers needs an end where an option has none.
constexpr double kLargest = 1e6;

}  // namespace

OptionForm::OptionForm(Changed changed, QWidget* parent)
    : QWidget(parent), m_changed(std::move(changed)), m_layout(new QFormLayout(this)) {
  setObjectName(QStringLiteral("optionForm"));
  m_layout->setContentsMargins(0, 0, 0, 0);
}

void OptionForm::show(const std::vector<SamplingOption>& schema, const OptionValues& values) {
  if (schema != m_schema) build(schema);
  for (const SamplingOption& option : m_schema) {
    const auto found = values.find(option.name);
    display(option, found == values.end() ? option.fallback : found->second);
  }
  setVisible(!m_schema.empty());
}

void OptionForm::build(const std::vector<SamplingOption>& schema) {
  while (m_layout->rowCount() > 0) m_layout->removeRow(0);
  m_fields.clear();
  m_schema = schema;
  for (const SamplingOption& option : m_schema) {
    QWidget* field = fieldOf(option);
    field->setObjectName(QStringLiteral("option_") + QString::fromStdString(option.name));
    field->setToolTip(QString::fromStdString(option.about));
    m_fields[option.name] = field;
    m_layout->addRow(QString::fromStdString(option.title), field);
  }
}

QWidget* OptionForm::fieldOf(const SamplingOption& option) {
  if (option.kind == SamplingOption::Kind::Switch) {
    auto* box = new QCheckBox(this);
    connect(box, &QCheckBox::toggled, this,
            [this, option](bool on) { m_changed(option, on ? 1.0 : 0.0); });
    return box;
  }
  auto* box = new NumberBox(this);
  box->setRange(option.low, std::min(option.high, kLargest));
  box->setSingleStep(0.05);
  if (!option.unit.empty())
    box->setSuffix(QStringLiteral(" ") + QString::fromStdString(option.unit));
  connect(box, qOverload<double>(&QDoubleSpinBox::valueChanged), this,
          [this, option](double value) { m_changed(option, value); });
  return box;
}

void OptionForm::display(const SamplingOption& option, double value) {
  QWidget* field = m_fields.at(option.name);
  if (option.kind == SamplingOption::Kind::Number)
    return static_cast<NumberBox*>(field)->display(value);
  const QSignalBlocker quiet(field);
  static_cast<QCheckBox*>(field)->setChecked(value != 0.0);
}

}  // namespace marey::gui
