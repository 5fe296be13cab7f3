// A form of what a sampling of a model takes, drawn from what its family declares.
#pragma once

#include <QFormLayout>
#include <QWidget>
#include <functional>
#include <map>

#include "model/sampling_option.h"

namespace marey::gui {

class OptionForm : public QWidget {
 public:
  using Changed = std::function<void(const SamplingOption& option, double value)>;
  OptionForm(Changed changed, QWidget* parent);
  /// One field for each option of the schema; hidden where it has none. Telling nobody.
  void show(const std::vector<SamplingOption>& schema, const OptionValues& values);

 private:
  void build(const std::vector<SamplingOption>& schema);
  QWidget* fieldOf(const SamplingOption& option);
  void display(const SamplingOption& option, double value);

  Changed m_changed;
  QFormLayout* m_layout;
  std::vector<SamplingOption> m_schema;
  std::map<std::string, QWidget*> m_fields;
};

}  // namespace marey::gui
