#pragma once

#include <string>

#include "analysis/export/study_data.h"

namespace passung::exporter {

/// The plans of the protocols with everything that they leave to a default, as JSON:
/// {"producer": "passung", "plans": [{"protocol_sha256": ..., "plan": {...}}]}.
std::string planJson(const StudyData& study);

}  // namespace passung::exporter
