#pragma once

#include <QtCore/QString>

#include "study/run/machine/loop_check.h"
#include "ui/presenter/study_details.h"

namespace passung::window {

// What a study's details mean, in the language of the windows.

/// "main, Williams square, 3 passes".
QString blockWords(const presenter::BlockLine& block, std::size_t sessions);
QString durationLine(const std::vector<double>& minutes);
/// A stage's name or why it runs, as the core says it.
QString stageWord(const std::string& text);
QString accuracyHint(bool asked_for);
QString pickLine(const presenter::AccuracyPoint& point, double budget_us);
QString loopVerdict(run::LoopFitness fitness);

enum class WhyNotMeasure { NotSound, SessionRuns, Measures };
QString whyNotMeasure(WhyNotMeasure why);

}  // namespace passung::window
