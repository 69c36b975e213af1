#include "study/run/machine/auto_accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>

#include "analysis/truth/accuracy_pick.h"
#include "study/protocol/felt_features.h"
#include "study/protocol/plan_json.h"
#include "study/run/files/builds.h"

namespace passung::run {

namespace {

constexpr double kUm = 1e6, kMm = 1e3, kUs = 1e6, kDegrees = 180.0 / std::numbers::pi;

/// Of a query [s], each once, ascending.
std::vector<double> budgetsOf(const plan::StudyPlan& plan) {
    std::set<double> budgets;
    for (const plan::Condition& condition : plan.conditions)
        if (condition.accuracy_budget > 0.0) budgets.insert(condition.accuracy_budget);
    return {budgets.begin(), budgets.end()};
}

/// As it is stored [µs], free of what rounding adds on the way from the protocol.
double inMicroseconds(double budget) { return std::round(1e12 * budget) / 1e6; }

std::string geometryOf(const scene::PartSpec& part) {
    std::string text = part.held ? "held " : "";
    if (const auto* mesh = std::get_if<scene::MeshFile>(&part.geometry))
        return text + fmt::format("{} {}", mesh->path, mesh->metres_per_unit);
    const auto& shape = std::get<shape::Shape>(part.geometry);
    text += shape::kindName(shape);
    for (const double value : shape::dimensions(shape)) text += fmt::format(" {}", value);
    return text;
}

/// What of a contact makes its query another one.
auto wayOfAsking(const scene::ContactSpec& contact) {
    const bool at_hand = contact.rendersAtHand();
    return std::tuple(at_hand, at_hand && contact.variant == scene::PenaltyVariant::AreaWeighted, contact.two_way);
}

/// One scene for every geometry among those that ask for a pick, with each way of asking once.
std::vector<truth::AskedScene> distinctScenes(const plan::StudyPlan& plan, scene::BuildStore* builds) {
    std::map<std::string, std::size_t> seen;
    std::vector<truth::AskedScene> scenes;
    // Shared by the scenes' questions, which outlive this.
    const auto geometries = std::make_shared<protocol::PartGeometries>(builds);
    for (const plan::Condition& condition : plan.conditions) {
        if (!(condition.accuracy_budget > 0.0)) continue;
        std::string key;
        for (const scene::PartSpec& part : condition.scene.parts) key += geometryOf(part) + '\n';
        const auto [place, fresh] = seen.try_emplace(key, scenes.size());
        if (fresh)
            scenes.push_back({&condition.scene, {}, [geometries, scene = condition.scene](double spacing) mutable {
                                  scene.contact.spacing = spacing;
                                  return !protocol::oneWayFeelsAll(scene, *geometries);
                              }});
        const scene::ContactSpec& contact = condition.scene.contact;
        auto& contacts = scenes[place->second].contacts;
        if (std::none_of(contacts.begin(), contacts.end(),
                         [&](const auto& other) { return wayOfAsking(other) == wayOfAsking(contact); }))
            contacts.push_back(contact);
    }
    return scenes;
}

/// Nothing where a spread is of no pose at all.
std::optional<double> asMeasured(double value) { return std::isnan(value) ? std::nullopt : std::optional(value); }

store::AccuracyRow asStored(const std::string& protocol_sha256, std::int64_t number, const truth::SettingCost& row) {
    return {.protocol_sha256 = protocol_sha256,
            .candidate = number,
            .mode = field::modeName(row.setting.mode),
            .tolerance_um = kUm * row.setting.tolerance,
            .spacing_mm = kMm * row.setting.spacing,
            .budget_nodes = row.setting.budget_nodes,
            .points = static_cast<std::int64_t>(row.points),
            .time_median_us = kUs * row.time.median,
            .time_p99_us = kUs * row.time.p99,
            .time_max_us = kUs * row.time.max,
            .error_mean_um = kUm * row.depth.mean,
            .error_p99_um = kUm * row.depth.p99,
            .error_max_um = kUm * row.depth.max,
            .force_error_p99_percent = asMeasured(100.0 * row.force.p99),
            .direction_error_p99_deg = asMeasured(kDegrees * row.direction.p99),
            .torque_error_p99_percent = asMeasured(100.0 * row.torque.p99)};
}

std::string keysOf(const store::AccuracyRow& row) {
    return fmt::format("tolerance_um = {:g}, spacing_mm = {:g}, mode = \"{}\", budget_nodes = {}", row.tolerance_um,
                       row.spacing_mm, row.mode, row.budget_nodes);
}

constexpr std::string_view kHead = "  {:>12} {:>10} {:>10} {:>9} {:>9} {:>9}  {}\n";

std::string errorsOf(const store::AccuracyRow& row) {
    const auto text = [](const std::optional<double>& value) { return value ? fmt::format("{:.3g}", *value) : "-"; };
    return fmt::format(" {:>9.3g} {:>9} {:>9} {:>9}  ", row.error_p99_um, text(row.force_error_p99_percent),
                       text(row.direction_error_p99_deg), text(row.torque_error_p99_percent));
}

/// `budget`: one of the plan's, below `fastest` [s].
Error unfitting(const plan::StudyPlan& plan, double budget, double fastest) {
    const auto asking =
        std::find_if(plan.conditions.begin(), plan.conditions.end(),
                     [&](const plan::Condition& condition) { return condition.accuracy_budget == budget; });
    return {
        .message =
            std::isfinite(fastest)
                ? fmt::format(
                      "no setting fits on this machine; the fastest with which every obstacle is felt takes {:.3g} µs",
                      kUs * fastest)
                : "no setting lets every pin, fin, wall and edge of the obstacles be felt",
        .file = plan.source_path,
        .line = asking->accuracy_line,
        .column = asking->accuracy_column,
        .key = "scene.contact.accuracy_budget_us",
        .value = fmt::format("{:g}", inMicroseconds(budget))};
}

/// The contact with what was picked; two ways where one would miss something.
void setContact(const truth::AccuracySetting& setting, scene::SceneSpec& scene, protocol::PartGeometries& geometries) {
    scene::ContactSpec& contact = scene.contact;
    contact.tolerance = setting.tolerance;
    contact.spacing = setting.spacing;
    contact.cell = 0.0;
    contact.budget_nodes = setting.budget_nodes;
    contact.mode = setting.mode;
    if (!contact.two_way) contact.two_way = !protocol::oneWayFeelsAll(scene, geometries);
}

/// In every scene that asks for a pick.
bool feelsEverywhere(const plan::StudyPlan& plan, const truth::AccuracySetting& setting,
                     protocol::PartGeometries& geometries) {
    return std::all_of(plan.conditions.begin(), plan.conditions.end(), [&](const plan::Condition& condition) {
        if (!(condition.accuracy_budget > 0.0)) return true;
        scene::SceneSpec scene = condition.scene;
        setContact(setting, scene, geometries);
        return protocol::feelsEverything(scene, geometries);
    });
}

Result<field::FieldMode> modeOf(const store::AccuracyRow& row) {
    if (const auto mode = field::modeNamed(row.mode)) return *mode;
    return Error{.message = "this version of the program does not know the mode that was picked",
                 .key = "contact.mode",
                 .value = row.mode};
}

}  // namespace

bool asksForAccuracy(const plan::StudyPlan& plan) { return !budgetsOf(plan).empty(); }

Result<std::vector<store::AccuracyRow>> measureAccuracy(const plan::StudyPlan& plan, const std::string& protocol_sha256,
                                                        const truth::StepReport& report, scene::BuildStore* builds) {
    const std::vector<double> budgets = budgetsOf(plan);
    const auto measured = truth::measureCandidates(
        distinctScenes(plan, builds), budgets, report ? report : [](const std::string&, double) {}, builds);
    if (!measured) return measured.errors();
    protocol::PartGeometries geometries(builds);
    std::vector<store::AccuracyRow> rows;
    std::vector<truth::SettingCost> felt;  // with what may be picked, and where it stands in `rows`
    std::vector<std::size_t> places;
    double fastest = std::numeric_limits<double>::infinity();
    for (const truth::SettingCost& row : *measured) {
        rows.push_back(asStored(protocol_sha256, static_cast<std::int64_t>(rows.size()), row));
        if (!feelsEverywhere(plan, row.setting, geometries)) continue;
        felt.push_back(row);
        places.push_back(rows.size() - 1);
        fastest = std::min(fastest, row.time.p99);
    }
    Errors errors;
    for (const double budget : budgets) {
        if (const auto best = truth::pickFinest(felt, budget))
            rows[places[*best]].picked_for_us.push_back(inMicroseconds(budget));
        else
            errors.push_back(unfitting(plan, budget, fastest));
    }
    if (!errors.empty()) return errors;
    return rows;
}

Result<Done> applyAccuracy(const std::string& protocol_sha256, std::span<const store::AccuracyRow> rows,
                           plan::StudyPlan& plan, const ImportLimits& limits) {
    Builds builds(nullptr, limits);
    protocol::PartGeometries geometries(&builds);
    for (plan::Condition& condition : plan.conditions) {
        if (!(condition.accuracy_budget > 0.0)) continue;
        const double budget = inMicroseconds(condition.accuracy_budget);
        const auto pick = std::find_if(rows.begin(), rows.end(), [&](const store::AccuracyRow& row) {
            const auto& budgets = row.picked_for_us;
            return row.protocol_sha256 == protocol_sha256 &&
                   std::find(budgets.begin(), budgets.end(), budget) != budgets.end();
        });
        if (pick == rows.end())
            return Error{.message = "nothing was picked for this budget in the database: the protocol never ran there",
                         .key = "contact.accuracy_budget_us",
                         .value = fmt::format("{:g}", budget)};
        const auto mode = modeOf(*pick);
        if (!mode) return mode.errors();
        setContact({*mode, pick->tolerance_um / kUm, pick->spacing_mm / kMm, static_cast<int>(pick->budget_nodes)},
                   condition.scene, geometries);
        condition.accuracy_picked = true;
        condition.params_json = protocol::paramsJson(condition);
    }
    return Done{};
}

Result<std::vector<std::string>> tooSlowHere(const plan::StudyPlan& plan, std::span<const store::AccuracyRow> rows,
                                             scene::BuildStore* builds) {
    std::vector<std::string> slow;
    for (const store::AccuracyRow& row : rows) {
        if (row.picked_for_us.empty()) continue;
        const auto mode = modeOf(row);
        if (!mode) return mode.errors();
        const auto time = truth::timeOfSetting(
            distinctScenes(plan, builds),
            {*mode, row.tolerance_um / kUm, row.spacing_mm / kMm, static_cast<int>(row.budget_nodes)}, builds);
        if (!time) return time.errors();
        for (const double budget : row.picked_for_us)
            if (kUs * *time > budget)
                slow.push_back(
                    fmt::format("accuracy_budget_us = {:g} is not kept on this machine: what the study picked "
                                "({}) takes {:.3g} µs here (99th percentile)",
                                budget, keysOf(row), kUs * *time));
    }
    return slow;
}

std::string describePick(std::span<const store::AccuracyRow> rows) {
    std::string text =
        fmt::format(kHead, "budget [µs]", "p99 [µs]", "depth [µm]", "force [%]", "dir. [°]", "torque [%]", "picked");
    for (const store::AccuracyRow& row : rows)
        for (const double budget : row.picked_for_us)
            text += fmt::format("  {:>11g} {:>9.3g}{}{}\n", budget, row.time_p99_us, errorsOf(row), keysOf(row));
    text += fmt::format(
        "  {} settings measured; picked: the least depth error within the budget; times and errors are 99th "
        "percentiles over poses along contact paths\n",
        rows.size());
    return text;
}

std::string describeAccuracy(std::span<const store::AccuracyRow> rows) {
    std::string text = describePick(rows);
    text +=
        fmt::format(kHead, "median [µs]", "p99 [µs]", "depth [µm]", "force [%]", "dir. [°]", "torque [%]", "candidate");
    for (const store::AccuracyRow& row : rows)
        text += fmt::format("  {:>11.3g} {:>9.3g}{}{}{}\n", row.time_median_us, row.time_p99_us, errorsOf(row),
                            keysOf(row), row.picked_for_us.empty() ? "" : "  <- picked");
    return text;
}

}  // namespace passung::run
