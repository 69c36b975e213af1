#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/plan/frozen_plan.h"
#include "study/plan/run_choice.h"
#include "study/run/files/mesh_importer.h"
#include "study/store/rows/rows.h"

namespace passung::run {

/// What a database keeps of a protocol, and of the session that is to run.
struct KeptPlan {
    std::string protocol_sha256;
    std::vector<plan::StableStiffness> stable_stiffness;  // none: the devices' rated ones
    std::vector<store::AccuracyRow> accuracy;             // rows of other protocols do not count
    std::vector<store::ContactGeometryRow> geometry;      // none: as this program picks it
    /// The bytes of a questionnaire's file by its path; empty: questionnaires stay as the draft has them.
    std::function<Result<std::string>(const std::string& path)> questionnaires = {};
    std::string language = {};  // of these questionnaires; empty: the protocol's
};

/// The plan as the database runs it: the draft as its text says, what the run decides, and what the database keeps. A
/// geometry of contact that the text leaves to the program is the one with which the study began.
/// Where kept stable maxima differ from the draft's, its conditions are read again from its text. Errors: a stiffness
/// above a kept maximum; a budget of accuracy = "auto" that nothing was picked for; a questionnaire that cannot be
/// read.
Result<plan::FrozenPlan> freeze(plan::StudyPlan draft, const KeptPlan& kept, const plan::RunChoice& choice = {},
                                const ImportLimits& limits = {});

}  // namespace passung::run
