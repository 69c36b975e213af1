#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace passung::test {

inline bool hasR() { return std::system("Rscript --version > /dev/null 2>&1") == 0; }

/// R with what a report needs of it (report_packages of ./dev).
inline bool hasReportPackages() {
    return std::system(
               "Rscript --vanilla -e 'stopifnot(vapply(c(\"rmarkdown\", \"knitr\", \"jsonlite\", \"digest\", \"afex\", "
               "\"emmeans\", \"lme4\", \"lmerTest\", \"survival\", \"coin\", \"effectsize\", \"ordinal\"), "
               "requireNamespace, NA, "
               "quietly = TRUE), Sys.which(\"pandoc\") != \"\")' > /dev/null 2>&1") == 0;
}

constexpr const char* kNoReportPackages = "R or a package of a report is not installed (report_packages of ./dev)";

/// What a command of the shell prints.
inline std::string ask(const std::string& command, int& code) {
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    std::string text;
    char buffer[4096];
    for (std::size_t n = 0; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, n);
    code = pclose(pipe);
    return text;
}

/// What Rscript prints with these arguments, as a shell reads them.
inline std::string askR(const std::string& arguments, int& code) {
    return ask("LC_ALL=C.UTF-8 Rscript --vanilla " + arguments, code);
}

/// Makes the reports in these folders, which have none yet, by one R for all: packages load once.
inline std::string renderAll(const std::vector<std::string>& folders, int& code) {
    std::string list;
    for (const std::string& folder : folders) list += (list.empty() ? "\"" : ", \"") + folder + "\"";
    return askR("-e 'for (folder in c(" + list +
                    ")) { setwd(folder); rmarkdown::render(\"analysis.Rmd\", output_file = \"report.html\", quiet = "
                    "TRUE) }'",
                code);
}

/// While it lives no program is found on the search path, R neither.
class WithoutPrograms {
public:
    WithoutPrograms() : path_(std::getenv("PATH")) { setenv("PATH", "/nowhere", 1); }
    ~WithoutPrograms() { setenv("PATH", path_.c_str(), 1); }
    WithoutPrograms(const WithoutPrograms&) = delete;
    WithoutPrograms& operator=(const WithoutPrograms&) = delete;

private:
    std::string path_;
};

/// Prints what a page and its results say that cannot be: tests/ui/cli/report_page.R.
inline std::string checkPage(const std::string& folder, int& code) {
    return askR(std::string(PASSUNG_SOURCE_DIR) + "/tests/ui/cli/report_page.R '" + folder + "'", code);
}

}  // namespace passung::test
