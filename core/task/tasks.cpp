#include <array>

#include "task/task_list.h"

#include "base/error.h"

namespace marey {

std::span<const Task> tasks() {
  static const std::array all{followTask(), steerTask(), predictTask(), completeTask(),
                              denoiseTask()};
  return all;
}

const Task& taskNamed(const std::string& name) {
  std::string known;
  for (const Task& task : tasks()) {
    if (task.name == name) return task;
    known += (known.empty() ? "" : ", ") + task.name;
  }
  throw InputError({.path = "task"}, "one of " + known, "'" + name + "'");
}

TaskOutcome runTask(const Task& task, const MotionModel& model, const TaskRequest& request,
                    Progress& progress) {
  if (const std::string why = task.whyNot(model); !why.empty())
    throw InputError({.path = model.info().variant}, "a model that can " + task.name, why);
  return task.run(model, request, progress);
}

}  // namespace marey
