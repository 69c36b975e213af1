#pragma once

#include <string_view>
#include <vector>

namespace passung::report {

/// A file of the room that stands in every report's folder as it is.
struct FolderText {
    std::string_view name, text;
};

/// Written at build time from the files that CMakeLists.txt lists.
std::vector<FolderText> folderTexts();

}  // namespace passung::report
