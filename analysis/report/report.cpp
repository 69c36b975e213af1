#include "analysis/report/report.h"

#include "analysis/report/analysis_text.h"
#include "analysis/report/course_file.h"
#include "analysis/report/folder_texts.h"
#include "analysis/report/r_program.h"

namespace passung::report {
namespace {

constexpr const char* kAnalysis = "analysis.Rmd";

std::vector<exporter::ExportedFile> filesBeside(const AnalysisText& text) {
    std::vector<exporter::ExportedFile> files = {
        {kAnalysis, text.text,
         "The planned analyses as R Markdown, to be edited; in this folder `Rscript -e "
         "'rmarkdown::render(\"analysis.Rmd\", "
         "output_file = \"report.html\")'` makes `report.html`, and `results.json` with every number of it."}};
    for (const FolderText& file : folderTexts())
        files.push_back({std::string(file.name), std::string(file.text), "Used by `analysis.Rmd`."});
    return files;
}

}  // namespace

Result<ReportOutcome> writeReport(const store::StoreReader& reader, const std::string& out_dir,
                                  const exporter::ExportOptions& options) {
    ReportOutcome outcome;
    AnalysisText text;
    exporter::ExportOptions more = options;
    more.more_files = [&](const exporter::StudyData& study) -> Result<std::vector<exporter::ExportedFile>> {
        text = writeAnalysis(study);
        outcome.analyses = text.analyses;
        std::vector<exporter::ExportedFile> files = filesBeside(text);
        auto courses = courseFile(reader, study);
        if (!courses) return courses.errors();
        if (!courses->columns.empty()) files.push_back(*std::move(courses));
        return files;
    };
    more.in_folder = [&](const std::filesystem::path& folder) -> std::vector<std::string> {
        outcome.missing = installCommand(missingPrograms(text.packages));
        if (!outcome.missing.empty()) return {};
        const Evaluated page = render(folder, kAnalysis, "report.html");
        outcome.said = page.said;
        outcome.failed = page.failed;
        if (!page.failed.empty()) return {};
        return {"report.html", "results.json"};
    };
    auto tables = exporter::exportAll(reader, out_dir, more);
    if (!tables) return tables.errors();
    outcome.tables = *std::move(tables);
    return outcome;
}

}  // namespace passung::report
