#include "experiment/experiment_case.h"

#include <algorithm>

#include "base/json_lists.h"

namespace marey {
namespace {

const TaskOption* optionNamed(const Task& task, const std::string& name) {
  const auto found = std::find_if(task.options.begin(), task.options.end(),
                                  [&](const TaskOption& o) { return o.name == name; });
  return found == task.options.end() || !found->number ? nullptr : &*found;
}

const Task& taskOf(JsonReader& reader) {
  const auto name = reader.required<std::string>("task");
  std::string known;
  for (const Task& task : tasks()) {
    if (task.from != Task::From::Clips) continue;
    if (task.name == name) return task;
    known += (known.empty() ? "" : ", ") + task.name;
  }
  throw InputError(reader.place("task"), "one of " + known, "'" + name + "'");
}

std::map<std::string, double> optionsFrom(JsonReader& reader, const Task& task,
                                          const std::string& origin, const std::string& prefix) {
  std::map<std::string, double> out;
  if (!reader.has("options")) return out;
  JsonReader options(reader.raw("options"), origin, prefix + "options.");
  for (const TaskOption& option : task.options) {
    if (!option.number || !options.has(option.name)) continue;
    const double value =
        option.whole ? options.required<int>(option.name) : options.required<double>(option.name);
    requireAtLeast(options, option.name.c_str(), value, option.least);
    out[option.name] = value;
  }
  options.finish();
  return out;
}

}  // namespace

ExperimentCase caseFromJson(const Json& value, const std::string& origin,
                            const std::string& prefix) {
  JsonReader reader(value, origin, prefix);
  ExperimentCase out;
  out.name = reader.required<std::string>("name");
  const Task& task = taskOf(reader);
  out.task = task.name;
  out.options = optionsFrom(reader, task, origin, prefix);
  out.samples = reader.optional("samples", 1);
  reader.finish();
  requireAtLeast(reader, "samples", out.samples, 1);
  return out;
}

Json toJson(const ExperimentCase& c) {
  Json out = {{"name", c.name}, {"task", c.task}, {"samples", c.samples}};
  for (const auto& [name, value] : c.options) {
    const bool whole = optionNamed(taskNamed(c.task), name)->whole;
    out["options"][name] = whole ? Json(static_cast<int64_t>(value)) : Json(value);
  }
  return out;
}

TaskRequest requestOf(const ExperimentCase& c, uint64_t seed, const ExperimentSystem& system) {
  const Task& task = taskNamed(c.task);
  TaskRequest out{.samples = c.samples,
                  .seed = seed,
                  .temperature = system.temperature,
                  .options = system.options};
  for (const auto& [name, value] : c.options) optionNamed(task, name)->number(out, value);
  return out;
}

}  // namespace marey
