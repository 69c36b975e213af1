#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace passung::report {

/// Those of R, pandoc and R's `packages` that are not here, as Debian names them.
std::vector<std::string> missingPrograms(const std::vector<std::string>& packages);

/// The line that installs them; empty for none.
std::string installCommand(const std::vector<std::string>& programs);

struct Rendered {
    std::string failed;             // R's last words; empty: it made the page
    std::vector<std::string> said;  // its other lines
};

/// Lets R make `page` of the R Markdown file `text`, both in `folder`.
Rendered render(const std::filesystem::path& folder, const std::string& text, const std::string& page);

}  // namespace passung::report
