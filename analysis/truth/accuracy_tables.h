#pragma once

#include <string>
#include <vector>

#include "analysis/truth/accuracy_sweep.h"

namespace passung::truth {

/// CSV: a header and one line per setting.
std::string accuracyCsv(const std::vector<SettingCost>& rows);

/// CSV: the poses and their truth. Its first seven columns are what `passung query --poses` reads.
std::string posesCsv(const std::vector<JudgedPose>& poses);

/// CSV: every column of the two tables above with file, unit and meaning.
std::string accuracyCodebook();

/// A setting in words: "10 µm, 1 mm, trilinear, 300 nodes".
std::string settingText(const AccuracySetting& setting);

/// For a terminal: the settings on each front, from fast to accurate.
std::string frontText(const std::vector<SettingCost>& rows);

}  // namespace passung::truth
