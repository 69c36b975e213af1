#pragma once

#include <functional>

#include "study/run/run_study.h"

namespace passung::app {

/// What `perform` does with the listener that it is given: `listener` and, if there is one, the log, which learns how
/// the run ended as well.
Result<RunEnd> logged(StudyLog* log, const RunListener& listener,
                      const std::function<Result<RunEnd>(const RunListener&)>& perform);

}  // namespace passung::app
