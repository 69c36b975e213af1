#pragma once

#include <string>
#include <vector>

#include "analysis/export/study_data.h"

namespace passung::report {

/// A text of R Markdown, and what it needs.
struct AnalysisText {
    std::string text = {};
    std::vector<std::string> packages = {};  // of R, and pandoc
    std::size_t analyses = 0;
};

/// The planned analyses of the stored protocols as R Markdown: calls that an analyst writes, on files that lie beside
/// it. It holds names and levels of the plan, no number about the data.
AnalysisText writeAnalysis(const exporter::StudyData& study);

}  // namespace passung::report
