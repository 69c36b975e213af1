#pragma once

#include <string>

#include "study/plan/task.h"

namespace passung::protocol {

/// {"position_m": [x, y, z], "quaternion_wxyz": [w, x, y, z]}
std::string poseJson(const Pose& pose);

/// Every number of a task, for the attempt's row.
std::string taskJson(const plan::Task& task);

}  // namespace passung::protocol
