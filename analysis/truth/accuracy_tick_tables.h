#pragma once

#include <string>

#include "analysis/truth/accuracy_ticks.h"

namespace passung::truth {

/// CSV: a header and one line per setting.
std::string tickCsv(const TickAccuracy& result);

/// CSV: every column of it with file, unit and meaning.
std::string tickCodebook();

/// A setting in words: "god_object, field, 10 µm, 1 mm, trilinear, two ways, 300 nodes".
std::string settingText(const TickSetting& setting);

/// For a terminal: every setting, from fast to slow; those on a front are marked.
std::string tickText(const TickAccuracy& result);

/// What the picture says besides the rows.
struct TickPictureText {
    std::string scene, path;  // names of the files
};

/// An SVG of two panels, true overlap and error of the force over the time of a tick, both logarithmic. Bars: from the
/// median to the 99.9th percentile of the time; from the overlap that was found to its bound, and from the median to
/// the 99th percentile of the force's error.
std::string tickPicture(const TickAccuracy& result, const TickPictureText& text);

/// Is `picture` one of the same scene and path, by their names?
bool isTickPictureOf(const std::string& picture, const TickPictureText& text);

}  // namespace passung::truth
