#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace passung::report {

/// Those of R and of what is needed, R's packages or pandoc, that are not here, as Debian names them.
std::vector<std::string> missingPrograms(const std::vector<std::string>& needed);

/// The line that installs them; empty for none.
std::string installCommand(const std::vector<std::string>& programs);

/// What came of an expression of R.
struct Evaluated {
    std::string failed;             // R's last words; empty: it came to its end
    std::vector<std::string> said;  // its other lines of warnings and messages
};

/// Lets R evaluate an expression in `folder`.
Evaluated evaluate(const std::filesystem::path& folder, const std::string& expression);

/// Lets R make `page` of the R Markdown file `text`, both in `folder`.
Evaluated render(const std::filesystem::path& folder, const std::string& text, const std::string& page);

}  // namespace passung::report
