#pragma once

#include <QtCore/QString>

#include "study/run/machine/front_file.h"
#include "study/run/operating_point.h"
#include "ui/presenter/tick_plot.h"

namespace passung::window {

// What is said about the price of accuracy, in the language of the windows. Names of keys are those of protocols.
// `cell`: edge of a field's cell that the study itself names [m]; 0: the tolerance decides.

/// Three digits.
QString numberWord(double value);
/// What a setting of fields has besides, for a table: "20 µm · 1 mm · trilinear · both ways"; else empty.
QString detailWords(const truth::TickSetting& setting, double cell);
/// All of it: "god_object · field · tolerance 20 µm · points 1 mm apart · trilinear".
QString settingWords(const truth::TickSetting& setting, double cell);
/// A setting with what it costs.
QString costWords(const truth::PathCost& row, double cell);
/// What is done before the first setting is measured.
QString pathWord();
/// Along which path it was measured.
QString pathWords(const run::TickFront& front);
/// Who measured a front that was read from a file, when and where.
QString originWords(const run::FrontOrigin& origin);
/// How long measuring goes on [s]: "about 3 min left".
QString leftWords(double seconds);
QString noErrorWords(presenter::TickError error);
QString outcomeWords(const run::OperatingPoint& point);

/// Why nothing is measured: the trials are done with real parts; a session began meanwhile.
enum class WhyNoFront { RealParts, SessionBegan };
QString noFrontWords(WhyNoFront why);

enum class WhyNotUse { NothingChosen, Writes };
QString whyNotUse(WhyNotUse why);

}  // namespace passung::window
