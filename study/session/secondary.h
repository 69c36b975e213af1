#pragma once

#include "study/measures/detection.h"
#include "study/plan/secondary_task.h"

namespace passung::session {

/// Times within which presses of the protocol's secondary task count.
inline measures::DetectionSettings detectionSettings(const plan::SecondaryTask& task) {
    return {task.least_interval, task.most_interval, task.duration, task.earliest, task.latest, task.button};
}

}  // namespace passung::session
