#include "study/run/freeze.h"

#include <algorithm>
#include <optional>

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
    plan.analyses.clear();
    plan.data_rules.clear();
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

/// The draft's text read once more, if at all, with distance fields wherever it leaves the geometry to the program:
/// what these take from features of the parts, which nobody looked for in the draft.
class SampledReading {
public:
    SampledReading(const plan::StudyPlan& draft, std::span<const plan::StableStiffness> kept,
                   const ImportLimits& limits)
        : draft_(draft), devices_(devicesAsKept(kept)), limits_(limits) {}

    /// Of that name. Errors: the text cannot be read as it was.
    Result<plan::Condition> condition(const std::string& name) {
        if (!read_)
            read_ =
                readBegunProtocol(draft_.source_text, draft_.source_path, devices_, limits_, scene::Geometry::Field);
        if (!*read_) return read_->errors();
        for (const plan::Condition& condition : (*read_)->conditions)
            if (condition.name == name) return condition;
        return Error{.message = "is not in the study's text", .key = "condition", .value = name};
    }

private:
    const plan::StudyPlan& draft_;
    std::vector<DeviceDescription> devices_;
    ImportLimits limits_;
    std::optional<Result<plan::StudyPlan>> read_;
};

/// `sampled`: gives the same scene as it is with distance fields.
Result<Done> keepGeometry(const std::string& kept, scene::SceneSpec& scene,
                          const std::function<Result<scene::SceneSpec>()>& sampled) {
    const auto geometry = scene::geometryNamed(kept);
    if (scene.contact.geometry != scene::Geometry::Auto || !geometry) return Done{};
    if (*geometry == scene::Geometry::Field && scene::geometryOf(scene).geometry != scene::Geometry::Field) {
        const auto again = sampled();
        if (!again) return again.errors();
        scene.contact = again->contact;
    }
    scene.contact.geometry = *geometry;
    return Done{};
}

/// Another version of the program may pick another one.
Result<Done> keepGeometry(const KeptPlan& kept, plan::StudyPlan& plan, const ImportLimits& limits) {
    SampledReading sampled(plan, kept.stable_stiffness, limits);
    for (plan::Condition& condition : plan.conditions) {
        const auto row = std::find_if(kept.geometry.begin(), kept.geometry.end(),
                                      [&](const auto& r) { return r.condition == condition.name; });
        if (row == kept.geometry.end()) continue;
        const auto shown = [&](auto sceneOf) {
            return [&, sceneOf]() -> Result<scene::SceneSpec> {
                auto again = sampled.condition(condition.name);
                if (!again) return again.errors();
                return sceneOf(*again);
            };
        };
        auto done = keepGeometry(row->geometry, condition.scene, shown([](const auto& again) { return again.scene; }));
        if (done && condition.comparison)
            done = keepGeometry(row->comparison, *condition.comparison,
                                shown([](const auto& again) { return again.comparison.value_or(again.scene); }));
        if (!done) return done;
        condition.params_json = protocol::paramsJson(condition);
    }
    if (!kept.geometry.empty()) plan.expanded_json = protocol::expandedJson(plan);
    return Done{};
}

}  // namespace

Result<plan::FrozenPlan> freeze(plan::StudyPlan draft, const KeptPlan& kept, const plan::RunChoice& choice,
                                const ImportLimits& limits) {
    draft.seed = choice.seedOf(draft);
    if (choice.trials_only) keepTrialsOnly(draft);
    if (const auto done = keepStiffness(kept.stable_stiffness, draft, limits); !done) return done.errors();
    if (const auto done = keepGeometry(kept, draft, limits); !done) return done.errors();
    if (const auto done = applyAccuracy(kept.protocol_sha256, kept.accuracy, draft, limits); !done)
        return done.errors();
    if (kept.questionnaires)
        if (const auto done = protocol::loadQuestionnaires(draft, kept.questionnaires, kept.language); !done)
            return done.errors();
    return plan::FrozenPlan(std::move(draft));
}

}  // namespace passung::run
