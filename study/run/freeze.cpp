#include "study/run/freeze.h"

#include <algorithm>

#include "core/scene/contact_geometry.h"
#include "study/plan/plan_contents.h"
#include "study/protocol/plan_json.h"
#include "study/protocol/planned_questionnaires.h"
#include "study/run/files/protocol_files.h"
#include "study/run/machine/auto_accuracy.h"
#include "study/run/machine/calibration.h"

namespace passung::run {

namespace {

/// Leaves of a try-out nothing but its trials.
void keepTrialsOnly(plan::StudyPlan& plan) {
    plan.consent.clear();
    plan.instructions.clear();
    plan.questionnaires.clear();
}

/// Takes from another reading of the draft's text what follows from stable maxima, if the kept ones are others.
Result<Done> keepStiffness(std::span<const plan::StableStiffness> kept, plan::StudyPlan& plan,
                           const ImportLimits& limits) {
    const auto devices = devicesAsKept(kept);
    if (sameStiffness(plan::stableStiffnessOf(plan, devices), plan.stable_stiffness)) return Done{};
    auto again = readBegunProtocol(plan.source_text, plan.source_path, devices, limits);
    if (!again) return again.errors();
    plan.conditions = std::move(again->conditions);
    plan.stable_stiffness = std::move(again->stable_stiffness);
    plan.warnings = std::move(again->warnings);
    plan.expanded_json = protocol::expandedJson(plan);
    return Done{};
}

void keepGeometry(const std::string& kept, scene::SceneSpec& scene) {
    if (scene.contact.geometry != scene::Geometry::Auto) return;
    if (const auto geometry = scene::geometryNamed(kept)) scene.contact.geometry = *geometry;
}

/// Another version of the program may pick another one.
void keepGeometry(std::span<const store::ContactGeometryRow> kept, plan::StudyPlan& plan) {
    for (plan::Condition& condition : plan.conditions) {
        const auto row =
            std::find_if(kept.begin(), kept.end(), [&](const auto& r) { return r.condition == condition.name; });
        if (row == kept.end()) continue;
        keepGeometry(row->geometry, condition.scene);
        if (condition.comparison) keepGeometry(row->comparison, *condition.comparison);
        condition.params_json = protocol::paramsJson(condition);
    }
    if (!kept.empty()) plan.expanded_json = protocol::expandedJson(plan);
}

}  // namespace

Result<plan::FrozenPlan> freeze(plan::StudyPlan draft, const KeptPlan& kept, const plan::RunChoice& choice,
                                const ImportLimits& limits) {
    draft.seed = choice.seedOf(draft);
    if (choice.trials_only) keepTrialsOnly(draft);
    if (const auto done = keepStiffness(kept.stable_stiffness, draft, limits); !done) return done.errors();
    keepGeometry(kept.geometry, draft);
    if (const auto done = applyAccuracy(kept.protocol_sha256, kept.accuracy, draft, limits); !done)
        return done.errors();
    if (kept.questionnaires)
        if (const auto done = protocol::loadQuestionnaires(draft, kept.questionnaires, kept.language); !done)
            return done.errors();
    return plan::FrozenPlan(std::move(draft));
}

}  // namespace passung::run
