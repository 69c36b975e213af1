#pragma once

#include <QtCore/QString>
#include <optional>

#include "study/measures/assembly_watch.h"
#include "ui/presenter/run.h"
#include "ui/sound/sound_feed.h"

namespace passung::window {

// What presenters mean, in the language of the windows.

QString stateLine(const presenter::RunView& view);
QString stateDetail(const presenter::RunView& view);
QString rowWord(presenter::RowState state);
QString stepWord(measures::StepState state);
/// A sign that tells row states apart without colour.
QString rowSign(presenter::RowState state);
QString whyNot(presenter::Why why);
/// What came of a command.
QString warningLine(const std::string& warning);
QString answerLine(const presenter::CommandAnswered& answered);
QString qualityLine(const presenter::QualityFound& found);
QString soundLine(const std::optional<sound::SoundOutput>& output);
QString phaseWord(const std::string& phase);

}  // namespace passung::window
