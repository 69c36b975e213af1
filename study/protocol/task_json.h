#pragma once

#include <string>

#include "study/plan/task.h"

namespace passung::protocol {

/// Every number of a task, for the attempt's row.
std::string taskJson(const plan::Task& task);

}  // namespace passung::protocol
