#include "study/protocol/plan_json.h"

#include <filesystem>
#include <limits>

#include "core/base/json.h"
#include "core/scene/contact_geometry.h"
#include "study/design/allocation.h"
#include "study/protocol/task_json.h"

namespace passung::protocol {
namespace {

template <class T, class Function>
std::string listOf(const std::vector<T>& items, Function json) {
    std::vector<std::string> texts;
    texts.reserve(items.size());
    for (const auto& item : items) texts.push_back(json(item));
    return jsonList(texts);
}

std::string partJson(const scene::PartSpec& part) {
    JsonObject json;
    json.text("name", part.name).boolean("held", part.held);
    if (part.pickable) json.boolean("pickable", true);
    if (part.hand > 0) json.integer("hand", static_cast<std::int64_t>(part.hand) + 1);
    if (const auto* shape = std::get_if<shape::Shape>(&part.geometry)) {
        JsonObject shape_json;
        shape_json.text("kind", shape::kindName(*shape));
        for (const auto& [key, value] : shape::namedDimensions(*shape))
            shape_json.number(std::string(key) + "_m", value);
        json.json("shape", shape_json.str());
    } else {
        const auto& mesh = std::get<scene::MeshFile>(part.geometry);
        // Without its folder: where a lab keeps its files must not change what is exported.
        json.text("mesh", std::filesystem::path(mesh.path).filename().string())
            .number("metres_per_unit", mesh.metres_per_unit);
    }
    json.number("friction", part.friction).number("sliding_friction", part.sliding_friction);
    if (part.density > 0.0) json.number("density_kg_per_m3", part.density);
    return json.json("pose", poseJson(part.X_WP)).json("shown_offset_m", jsonVector(part.shown_offset)).str();
}

const char* variantName(scene::PenaltyVariant variant) {
    switch (variant) {
        case scene::PenaltyVariant::MaxNormalised:
            return "max_normalised";
        case scene::PenaltyVariant::AreaWeighted:
            return "area_weighted";
        case scene::PenaltyVariant::Raw:
            return "raw";
    }
    return "";
}

const char* couplingName(scene::PenaltyCoupling coupling) {
    switch (coupling) {
        case scene::PenaltyCoupling::Direct:
            return "direct";
        case scene::PenaltyCoupling::QuasiStatic:
            return "quasi_static";
        case scene::PenaltyCoupling::Virtual:
            return "virtual";
    }
    return "";
}

std::string contactJson(const plan::Condition& condition) {
    const scene::ContactSpec& contact = condition.scene.contact;
    const bool automatic = condition.accuracy_budget > 0.0;
    const scene::Geometry geometry = scene::geometryOf(condition.scene).geometry;
    JsonObject json;
    json.text("method", scene::methodName(contact.method))
        .text("geometry", scene::geometryName(geometry))
        .text("variant", variantName(contact.variant))
        .number("stiffness_N_per_m", contact.stiffness)
        .number("rotational_stiffness_Nm_per_rad", contact.rotational_stiffness)
        .boolean("allow_unstable", condition.allow_unstable)
        .number("damping_Ns_per_m", contact.damping)
        .number("rotational_damping_Nms_per_rad", contact.rotational_damping)
        .number("area_stiffness_N_per_m3", contact.area_stiffness);
    if (contact.coupling != scene::PenaltyCoupling::Direct)
        json.text("coupling", couplingName(contact.coupling))
            .number("penalty_stiffness_N_per_m", contact.penalty_stiffness);
    if (contact.coupling == scene::PenaltyCoupling::Virtual)
        json.number("tool_mass_kg", contact.tool_mass).number("tool_inertia_kg_m2", contact.tool_inertia);
    if (automatic) json.text("accuracy", "auto").number("accuracy_budget_s", condition.accuracy_budget);
    json.number("proxy_filter_hz", contact.proxy_filter);
    if (geometry != scene::Geometry::Field) return json.str();
    if (!automatic || condition.accuracy_picked)
        json.number("tolerance_m", contact.tolerance)
            .number("cell_m", contact.cell)
            .number("spacing_m", contact.spacing)
            .text("mode", field::modeName(contact.mode))
            .integer("budget_nodes", contact.budget_nodes);
    if (contact.quality > 0.0) json.number("quality", contact.quality);
    return json.boolean("two_way", contact.two_way).str();
}

std::string limitsJson(const scene::OutputLimits& limits) {
    return JsonObject()
        .number("max_force_N", limits.max_force)
        .number("max_torque_Nm", limits.max_torque)
        .number("max_force_rate_N_per_s", limits.max_force_rate)
        .number("max_speed_m_per_s", limits.max_speed)
        .number("max_spin_rad_per_s", limits.max_spin)
        .boolean("actuates_torque", limits.actuates_torque)
        .integer("delay_ticks", limits.delay_ticks)
        .str();
}

std::string registrationJson(const scene::Registration& registration) {
    return JsonObject()
        .json("device_base", poseJson(registration.X_WB))
        .number("scale", registration.scale)
        .json("handle", poseJson(registration.X_DH))
        .str();
}

std::string startGateJson(const scene::StartGate& gate) {
    return JsonObject()
        .number("position_tolerance_m", gate.position_tolerance)
        .number("angle_tolerance_rad", gate.angle_tolerance)
        .integer("hold_ticks", gate.hold_ticks)
        .str();
}

void addNavigation(const scene::Navigation& navigation, JsonObject& json) {
    const auto& [clutch, second_scale, drift] = navigation;
    if (clutch.button > 0)
        json.json("clutch",
                  JsonObject().integer("button", clutch.button).boolean("orientation", clutch.orientation).str());
    if (second_scale.button > 0)
        json.json("position_scale",
                  JsonObject().integer("button", second_scale.button).number("scale", second_scale.scale).str());
    if (drift.share > 0.0)
        json.json("drift", JsonObject().number("share", drift.share).number("radius_m", drift.radius).str());
}

/// The hands but the first, with their devices.
std::string otherHandsJson(const plan::Condition& condition) {
    std::vector<std::string> hands;
    for (std::size_t i = 0; i < condition.scene.other_hands.size(); ++i) {
        const scene::HandSpec& hand = condition.scene.other_hands[i];
        JsonObject json;
        json.text("hand", hand.name)
            .text("device", condition.other_devices.at(i))
            .json("limits", limitsJson(hand.limits))
            .json("registration", registrationJson(hand.registration))
            .json("start_gate", startGateJson(hand.start_gate));
        addNavigation(hand.navigation, json);
        hands.push_back(json.str());
    }
    return jsonList(hands);
}

std::string guidanceJson(const scene::Guidance& guidance) {
    return JsonObject()
        .number("share", guidance.share)
        .json("way", listOf(guidance.X_WG, poseJson))
        .number("speed_m_per_s", guidance.speed)
        .number("lead_m", guidance.lead)
        .number("stiffness_N_per_m", guidance.stiffness)
        .number("rotational_stiffness_Nm_per_rad", guidance.rotational_stiffness)
        .str();
}

/// Parts by their place in the scene, from 0, -1: the world; steps by theirs, from 1.
std::string stepJson(const scene::AssemblyStep& step) {
    const bool world = step.into == scene::AssemblyStep::kWorld;
    std::vector<std::string> after;
    for (std::size_t i = 0; i < scene::kMostSteps; ++i)
        if ((step.after & scene::stepBit(i)) != 0) after.push_back(std::to_string(i + 1));
    return JsonObject()
        .integer("part", static_cast<std::int64_t>(step.part))
        .integer("into", world ? -1 : static_cast<std::int64_t>(step.into))
        .json("goal", poseJson(step.X_IGoal))
        .number("position_tolerance_m", step.position_tolerance)
        .number("angle_tolerance_rad", step.angle_tolerance)
        .integer("symmetry", step.folds)
        .json("after", jsonList(after))
        .boolean("locks", step.locks)
        .str();
}

std::string pickJson(const scene::Pick& pick) {
    JsonObject json;
    json.number("reach_m", pick.reach)
        .integer("button", pick.button)
        .text("closed", pick.on_press ? "on_press" : "while_down")
        .text("let_go", pick.locks ? "lock" : "leave");
    if (!pick.steps.empty()) json.json("steps", listOf(pick.steps, stepJson));
    if (pick.undo_button > 0) json.integer("undo_button", pick.undo_button);
    return json.str();
}

std::string effectsJson(const scene::Effects& effects) {
    JsonObject json;
    json.number("passivity_damping_Ns_per_m", effects.passivity_damping);
    if (effects.transients.amplitude > 0.0)
        json.json("transients", JsonObject()
                                    .number("amplitude_Ns_per_m", effects.transients.amplitude)
                                    .number("frequency_hz", effects.transients.frequency)
                                    .number("decay_s", effects.transients.decay)
                                    .str());
    if (!effects.weight.gravity.isZero(0.0))
        json.json("weight", JsonObject().json("gravity_m_per_s2", jsonVector(effects.weight.gravity)).str());
    if (effects.viscosity.any())
        json.json("viscosity", JsonObject()
                                   .number("damping_Ns_per_m", effects.viscosity.damping)
                                   .number("rotational_damping_Nms_per_rad", effects.viscosity.rotational_damping)
                                   .str());
    if (effects.guidance.share > 0.0) json.json("guidance", guidanceJson(effects.guidance));
    if (effects.snap.any())
        json.json("snap", JsonObject()
                              .number("stiffness_N_per_m", effects.snap.stiffness)
                              .number("range_m", effects.snap.range)
                              .json("at", listOf(effects.snap.X_WG, poseJson))
                              .str());
    if (effects.inertia.any()) json.json("inertia", JsonObject().number("scale", effects.inertia.scale).str());
    if (effects.keep_apart.any())
        json.json("keep_apart", JsonObject()
                                    .number("stiffness_N_per_m", effects.keep_apart.stiffness)
                                    .number("range_m", effects.keep_apart.range)
                                    .str());
    if (effects.record) json.boolean("record", true);
    if (effects.picks()) json.json("pick", pickJson(effects.pick));
    addNavigation(effects.navigation, json);
    return json.str();
}

std::string cuesJson(const plan::Cues& cues) {
    return JsonObject()
        .boolean("visual", cues.visual)
        .boolean("vibrotactile", cues.vibrotactile)
        .boolean("audio", cues.audio)
        .boolean("masking_noise", cues.masking_noise)
        .number("full_depth_m", cues.full_depth)
        .number("full_speed_m_per_s", cues.full_speed)
        .number("sound_decay_s", cues.sound_decay)
        .str();
}

std::string secondaryJson(const plan::SecondaryTask& task) {
    return JsonObject()
        .text("stimulus", plan::stimulusName(task.stimulus))
        .number("interval_min_s", task.least_interval)
        .number("interval_max_s", task.most_interval)
        .number("stimulus_s", task.duration)
        .number("response_min_s", task.earliest)
        .number("response_max_s", task.latest)
        .integer("button", task.button)
        .str();
}

std::string textJson(const plan::StudyText& text) {
    JsonObject json;
    json.text("name", text.name);
    for (const auto& [language, words] : text.languages) json.text(language, words);
    return json.str();
}

std::string clauseJson(const plan::ConsentClause& clause) {
    JsonObject texts;
    for (const auto& [language, words] : clause.texts) texts.text(language, words);
    return JsonObject()
        .text("clause", clause.clause)
        .boolean("required", clause.required)
        .json("texts", texts.str())
        .str();
}

std::string instructionJson(const plan::Instruction& page) {
    return JsonObject()
        .text("moment", plan::showAtName(page.moment))
        .text("block", page.block)
        .text("text", page.text)
        .text("picture", page.picture)
        .str();
}

std::string factorJson(const plan::Factor& factor) {
    std::vector<std::string> levels;
    std::vector<std::string> catches;
    for (const auto& level : factor.levels) {
        levels.push_back(jsonText(level.label));
        if (level.catch_trial) catches.push_back(jsonText(level.label));
    }
    return JsonObject()
        .text("name", factor.name)
        .text("kind", plan::factorKindName(factor.kind))
        .text("unit", factor.unit)
        .json("levels", jsonList(levels))
        .json("catch_levels", jsonList(catches))
        .str();
}

std::string conditionJson(const plan::Condition& condition) {
    return JsonObject()
        .text("condition", condition.name)
        .json("levels", condition.levels_json)
        .json("params", condition.params_json)
        .str();
}

std::string stableJson(const plan::StableStiffness& stable) {
    return JsonObject()
        .text("device", stable.device)
        .number("stable_stiffness_N_per_m", stable.linear)
        .number("stable_rotational_stiffness_Nm_per_rad", stable.rotational)
        .text("origin", stable.origin)
        .str();
}

const char* repeatName(plan::Repeat repeat) {
    switch (repeat) {
        case plan::Repeat::Never:
            return "never";
        case plan::Repeat::Now:
            return "repeat_now";
        case plan::Repeat::AtBlockEnd:
            return "repeat_at_block_end";
    }
    return "";
}

std::string constraintJson(const plan::StudyPlan& plan, const design::Constraint& constraint) {
    using design::Rule;
    JsonObject json;
    const bool of_level = constraint.rule == Rule::FirstNot || constraint.rule == Rule::PositionWindow;
    json.text("rule", constraint.rule == Rule::MaxRun        ? "max_run"
                      : constraint.rule == Rule::MinDistance ? "min_distance"
                      : constraint.rule == Rule::FirstNot    ? "first_not"
                                                             : "position_window");
    if (constraint.factor) {
        const plan::Factor& factor = plan.factors[*constraint.factor];
        json.text("factor", factor.name);
        if (of_level) json.text("level", factor.levels[constraint.chosen].label);
    }
    if (!of_level) json.integer("count", static_cast<std::int64_t>(constraint.count));
    if (constraint.rule == Rule::PositionWindow)
        json.integer("from", static_cast<std::int64_t>(constraint.from))
            .integer("to", static_cast<std::int64_t>(constraint.to));
    return json.str();
}

/// Names of the conditions that the block has, its own ones where it has such.
std::string conditionsJson(const plan::StudyPlan& plan, const plan::Block& block) {
    std::vector<std::string> names;
    const design::Design design = plan::designOf(plan);
    const design::BlockPlan& planned = design.blocks[static_cast<std::size_t>(&block - plan.blocks.data())];
    for (std::size_t c = 0; c < design.conditions.size(); ++c)
        if (design::hasCondition(planned, c) && (!design.conditions[c].catch_trial || block.catches.trials > 0))
            names.push_back(jsonText(plan.conditions[design::numberIn(planned, c)].name));
    return jsonList(names);
}

std::string blockJson(const plan::StudyPlan& plan, const plan::Block& block) {
    std::vector<std::string> constraints;
    for (const design::Constraint& constraint : block.constraints)
        constraints.push_back(constraintJson(plan, constraint));
    return JsonObject()
        .text("name", block.name)
        .text("phase", plan::phaseName(block.phase))
        .integer("repetitions", block.repetitions)
        .text("order", plan::blockOrderName(block.order))
        .json("conditions", conditionsJson(plan, block))
        .text("blocked", block.blocked ? plan.factors[*block.blocked].name : "")
        .text("blocked_order", block.blocked ? plan::blockOrderName(block.blocked_order) : "")
        .json("constraints", jsonList(constraints))
        .integer("catch_trials", static_cast<std::int64_t>(block.catches.trials))
        .integer("catch_from", static_cast<std::int64_t>(block.catches.from))
        .integer("catch_to", static_cast<std::int64_t>(block.catches.to))
        .integer("trials", block.trials)
        .integer("session", block.session)
        .number("rest_s", block.rest)
        .text("rest_ends", plan::restEndsName(block.rest_ends))
        .text("on_failure", repeatName(block.on_failure))
        .text("on_timeout", repeatName(block.on_timeout))
        .text("on_invalid", repeatName(block.on_invalid))
        .integer("max_attempts", block.max_attempts)
        .str();
}

std::string trackJson(const plan::StaircaseTrack& track) {
    const design::AdaptiveParams& params = track.params;
    JsonObject json;
    json.text("track", track.name);
    if (params.method == design::AdaptiveMethod::Psi) {
        json.text("method", "psi")
            .number("guess", params.guess)
            .number("lapse", params.lapse)
            .number("sigma_low", params.sigma_low)
            .number("sigma_high", params.sigma_high);
    } else {
        json.text("method", "up_down")
            .integer("down_after", params.down_after)
            .number("start", params.start)
            .number("step_down", params.step_down)
            .number("step_up", params.step_up)
            .number("late_factor", params.late_factor)
            .integer("late_after", params.late_after)
            .integer("max_reversals", params.max_reversals)
            .integer("skip_reversals", params.skip_reversals);
    }
    return json.integer("max_trials", params.max_trials).str();
}

std::string staircaseJson(const plan::StudyPlan& plan, const plan::Staircase& staircase) {
    std::vector<std::string> tracks;
    for (const plan::StaircaseTrack& track : staircase.tracks) tracks.push_back(trackJson(track));
    return JsonObject()
        .text("staircase", staircase.name)
        .text("block", plan.blocks[staircase.block].name)
        .text("key", staircase.key)
        .text("unit", staircase.unit)
        .json("levels", jsonNumbers(staircase.levels))
        .boolean("logarithmic", staircase.tracks.front().params.logarithmic)
        .json("tracks", jsonList(tracks))
        .integer("catch_trials", static_cast<std::int64_t>(staircase.catch_trials))
        .number("catch_level", staircase.catch_level)
        .text("measure", staircase.measure)
        .number("threshold", staircase.threshold)
        .boolean("above", staircase.above)
        .number("reference", staircase.reference.value_or(std::numeric_limits<double>::quiet_NaN()))
        .str();
}

std::string resumeJson(const plan::ResumePolicy& resume) {
    return JsonObject()
        .number("max_age_s", resume.max_age)
        .text("practice", resume.redo_practice ? "redo" : "keep")
        .text("block", resume.restart_block ? "restart" : "continue")
        .str();
}

std::string questionnaireJson(const plan::PlannedQuestionnaire& planned) {
    return JsonObject()
        .text("questionnaire", planned.definition.key)
        .text("version", planned.definition.version)
        .text("file", planned.file)
        .text("texts", planned.texts)
        .text("language", planned.language)
        .text("moment", plan::momentName(planned.moment))
        .text("block", planned.block)
        .json("source", planned.source_json.empty() ? "null" : planned.source_json)
        .str();
}

std::string quoted(const std::string& text) { return jsonText(text); }

std::string contrastJson(const plan::Contrast& contrast) {
    return JsonObject()
        .text("factor", contrast.factor)
        .text("level", contrast.level)
        .text("against", contrast.against)
        .str();
}

std::string analysisJson(const plan::Analysis& analysis) {
    std::vector<std::string> factors;
    for (const auto& factor : analysis.factors) factors.push_back(jsonText(factor));
    JsonObject json;
    json.text("outcome", analysis.outcome)
        .json("factors", jsonList(factors))
        .text("test", analysis.test)
        .text("block", analysis.block)
        .text("staircase", analysis.staircase);
    if (!analysis.role.empty()) json.text("role", analysis.role);
    if (!analysis.transform.empty()) json.text("transform", analysis.transform);
    if (!analysis.covariates.empty()) json.json("covariates", listOf(analysis.covariates, quoted));
    if (!analysis.contrasts.empty()) json.json("contrasts", listOf(analysis.contrasts, contrastJson));
    if (analysis.equivalence_bounds)
        json.json("equivalence_bounds",
                  jsonNumbers({analysis.equivalence_bounds->first, analysis.equivalence_bounds->second}));
    if (!analysis.family.empty()) json.text("family", analysis.family);
    return json.str();
}

std::string dataRuleJson(const plan::DataRule& rule) {
    JsonObject json;
    json.text("data", rule.of_participants ? "participants" : "trials").text("value", rule.value);
    if (rule.below) json.number("below", *rule.below);
    if (rule.above) json.number("above", *rule.above);
    if (!rule.reason.empty()) json.text("reason", rule.reason);
    return json.str();
}

}  // namespace

std::string levelsJson(const std::vector<plan::Factor>& factors, const std::vector<std::size_t>& levels) {
    JsonObject json;
    for (std::size_t i = 0; i < factors.size(); ++i) json.text(factors[i].name, factors[i].levels[levels[i]].label);
    return json.str();
}

std::string paramsJson(const plan::Condition& condition) {
    const auto& scene = condition.scene;
    JsonObject json;
    json.text("device", condition.device);
    if (condition.needs)
        json.json("device_needs", JsonObject()
                                      .number("force_N", condition.needs->force)
                                      .number("torque_Nm", condition.needs->torque)
                                      .integer("degrees", condition.needs->degrees)
                                      .str());
    json.text("shown_pose", condition.shown == plan::ShownPose::Proxy ? "proxy" : "device")
        .text("result", plan::shownResultName(condition.result))
        .json("parts", listOf(scene.parts, partJson))
        .json("contact", contactJson(condition))
        .json("limits", limitsJson(scene.limits))
        .json("registration", registrationJson(scene.registration))
        .json("start_gate", startGateJson(scene.start_gate))
        .json("effects", effectsJson(scene.effects))
        .json("task", taskJson(condition.task));
    if (condition.scene.handCount() > 1) json.json("other_hands", otherHandsJson(condition));
    if (condition.cues.any()) json.json("cues", cuesJson(condition.cues));
    if (condition.comparison) {
        plan::Condition other = condition;
        other.scene = *condition.comparison;
        json.json("comparison", JsonObject()
                                    .json("parts", listOf(other.scene.parts, partJson))
                                    .json("contact", contactJson(other))
                                    .json("effects", effectsJson(other.scene.effects))
                                    .str());
    }
    if (!scene.display_wrench) json.boolean("kinesthetic", false);
    if (!condition.shows_scene) json.boolean("scene", false);
    if (condition.timed_by != plan::TimedBy::Program) json.text("timed_by", plan::timedByName(condition.timed_by));
    if (condition.secondary.any()) json.json("secondary", secondaryJson(condition.secondary));
    return json.str();
}

std::string expandedJson(const plan::StudyPlan& plan) {
    std::vector<std::string> staircases;
    for (const plan::Staircase& staircase : plan.staircases) staircases.push_back(staircaseJson(plan, staircase));
    JsonObject json;
    json.text("name", plan.name)
        .text("version", plan.version)
        .text("title", plan.title)
        .json("seed", std::to_string(plan.seed))
        .integer("participants", plan.participants)
        .json("factors", listOf(plan.factors, factorJson))
        .json("conditions", listOf(plan.conditions, conditionJson))
        .integer("planned_conditions", static_cast<std::int64_t>(plan::plannedConditions(plan)))
        .number("max_session_s", plan.max_session)
        .json("blocks", listOf(plan.blocks, [&](const plan::Block& block) { return blockJson(plan, block); }))
        .json("staircases", jsonList(staircases))
        .json("questionnaires", listOf(plan.questionnaires, questionnaireJson))
        .json("resume", resumeJson(plan.resume))
        .json("groups", listOf(plan::groupNames(plan), [](const std::string& name) { return jsonText(name); }))
        .integer("allocation_blocks", plan.allocation_blocks)
        .json("rows",
              listOf(design::rowsOf(plan::designOf(plan)), [](std::size_t rows) { return std::to_string(rows); }))
        .integer("sessions", plan::sessionsOf(plan))
        .json("analyses", listOf(plan.analyses, analysisJson))
        .json("languages", listOf(plan.languages, [](const std::string& language) { return jsonText(language); }))
        .json("consent", listOf(plan.consent, clauseJson))
        .json("texts", listOf(plan.texts, textJson))
        .json("instructions", listOf(plan.instructions, instructionJson))
        .json("loop", JsonObject().number("max_missed_share", plan.max_missed_share).str())
        .json("view", plan::viewJson(plan.view))
        .json("stable_stiffness", listOf(plan.stable_stiffness, stableJson))
        .json("measures", listOf(plan.measures, quoted));
    if (!plan.data_rules.empty()) json.json("data_rules", listOf(plan.data_rules, dataRuleJson));
    return json.str();
}

}  // namespace passung::protocol
