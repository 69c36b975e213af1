#pragma once

#include <string>
#include <vector>

#include "analysis/truth/accuracy_sweep.h"

namespace passung::truth {

/// What the picture says besides the rows.
struct PictureText {
    std::string field, shell;  // names of the parts
    std::size_t poses = 0, contacts = 0;
};

/// An SVG of two panels, error over time: of the signed distance and of the force; every setting a mark, coloured by
/// the point spacing, shaped by the mode; each Pareto front a line, its settings written beside it.
std::string accuracyPicture(const std::vector<SettingCost>& rows, const PictureText& text);

/// Is `picture` one of the same two parts, by their names?
bool isPictureOf(const std::string& picture, const PictureText& text);

}  // namespace passung::truth
