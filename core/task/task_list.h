// The tasks, one source each. Internal to this folder.
#pragma once

#include "task/task.h"

namespace marey {

Task followTask();
Task predictTask();
Task completeTask();
Task denoiseTask();
Task steerTask();

}  // namespace marey
