#pragma once

#include <functional>

#include "study/run/run_study.h"

namespace passung::run {

/// What `perform` does with the listener that it is given, which is not empty: it hands on to the log, if there is one,
/// and to `listener`. The log learns how the run ended as well.
Result<RunEnd> logged(StudyLog* log, const session::SessionListener& listener,
                      const std::function<Result<RunEnd>(const session::SessionListener&)>& perform);

}  // namespace passung::run
