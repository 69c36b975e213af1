#include "study/run/operating_point.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <vector>

#include "core/base/regular_file.h"
#include "core/scene/contact_geometry.h"
#include "study/protocol/contact_edit.h"
#include "study/run/files/builds.h"
#include "study/run/files/known_names.h"
#include "study/run/files/protocol_files.h"
#include "study/run/files/replace_file.h"
#include "study/store/read/store_reader.h"

namespace passung::run {

namespace {

using PointOutcome = OperatingPoint::Outcome;
using protocol::ContactKey;

constexpr double kUmPerM = 1e6, kMmPerM = 1e3;

/// The shortest number that is read as exactly this value, or where there is none as its neighbour.
std::string numberText(double value, double units) {
    std::string text;
    for (const int digits : {6, 9, 12, 15, 16, 17}) {
        text = fmt::format("{:.{}g}", value * units, digits);
        double read = 0.0;
        std::from_chars(text.data(), text.data() + text.size(), read);
        if (read / units == value) break;
    }
    return text;
}

std::string quoted(const char* word) { return fmt::format("\"{}\"", word); }

/// Tells whether each condition can have the geometry, so that the file may name it for all of them.
bool fitsAll(const plan::StudyPlan& plan, const plan::Condition& condition, const truth::TickSetting& setting) {
    const auto method = [](const plan::Condition& c) { return c.scene.contact.method; };
    const bool varied = std::any_of(plan.conditions.begin(), plan.conditions.end(),
                                    [&](const auto& c) { return method(c) != method(condition); });
    return std::all_of(plan.conditions.begin(), plan.conditions.end(), [&](const plan::Condition& c) {
        scene::SceneSpec scene = c.scene;
        scene.contact.geometry = setting.geometry;
        if (!varied) scene.contact.method = setting.method;
        return !scene::geometryProblem(scene);
    });
}

/// Auto stays where it picks the geometry here and other conditions cannot have it.
bool staysAuto(const plan::StudyPlan& plan, const plan::Condition& condition, const truth::TickSetting& setting) {
    scene::SceneSpec scene = condition.scene;
    scene.contact.method = setting.method;
    return scene.contact.geometry == scene::Geometry::Auto && scene::geometryOf(scene).geometry == setting.geometry &&
           !fitsAll(plan, condition, setting);
}

void addFieldKeys(const scene::ContactSpec& now, const TickFront& front, const truth::TickSetting& setting,
                  std::vector<ContactKey>& keys) {
    const auto& field = setting.field;
    const double cell = cellOf(front, setting);
    if (cell > 0.0) {
        keys.push_back({"cell_mm", numberText(cell, kMmPerM), now.cell == cell});
        if (now.tolerance != field.tolerance) keys.push_back({"tolerance_um", ""});
    } else {
        keys.push_back({"cell_mm", "", now.cell == 0.0});
        keys.push_back({"tolerance_um", numberText(field.tolerance, kUmPerM), now.tolerance == field.tolerance});
    }
    keys.push_back({"spacing_mm", numberText(field.spacing, kMmPerM), now.spacing == field.spacing});
    if (now.mode != field.mode) keys.push_back({"mode", quoted(field::modeName(field.mode))});
    if (now.budget_nodes != field.budget_nodes) keys.push_back({"budget_nodes", std::to_string(field.budget_nodes)});
    keys.push_back({"two_way", setting.two_way ? "true" : "false", now.two_way == setting.two_way});
}

std::vector<ContactKey> keysOf(const plan::StudyPlan& plan, const plan::Condition& condition, const TickFront& front,
                               const truth::TickSetting& setting) {
    const scene::ContactSpec& now = condition.scene.contact;
    std::vector<ContactKey> keys{{"method", quoted(scene::methodName(setting.method)), now.method == setting.method}};
    if (!staysAuto(plan, condition, setting))
        keys.push_back({"geometry", quoted(scene::geometryName(setting.geometry)), now.geometry == setting.geometry});
    if (condition.accuracy_budget > 0.0) {
        keys.push_back({"accuracy", ""});
        keys.push_back({"accuracy_budget_us", ""});
    }
    if (setting.geometry == scene::Geometry::Field) addFieldKeys(now, front, setting, keys);
    return keys;
}

/// Nothing: it has not. Errors: the database cannot be read.
Result<bool> hasBegun(const std::string& database) {
    if (!std::filesystem::exists(database)) return false;
    const auto reader = store::StoreReader::open(database);
    if (!reader) return reader.errors();
    const auto protocols = reader->protocols();
    if (!protocols) return protocols.errors();
    const auto sessions = reader->sessions();
    if (!sessions) return sessions.errors();
    return !protocols->empty() || !sessions->empty();
}

OperatingPoint refused(const Errors& errors) { return {PointOutcome::Refused, std::nullopt, errors.front()}; }

Result<plan::StudyPlan> readText(const std::string& text, const std::string& path) {
    Builds builds(nullptr, {});
    return protocol::readProtocolText(text, path, knownDevices(), knownMeasures(), &builds);
}

}  // namespace

OperatingPoint useSetting(const plan::StudyPlan& plan, std::size_t condition, const TickFront& front,
                          const truth::TickSetting& setting, const std::string& database) {
    const std::string& path = plan.source_path;
    const auto text = readFile(path);
    if (!text) return {PointOutcome::FileChanged, std::nullopt, text.errors().front()};
    const auto now = readText(*text, path);
    if (!now || now->source_text != plan.source_text || condition >= now->conditions.size())
        return {PointOutcome::FileChanged, std::nullopt, {}};
    const auto begun = hasBegun(database);
    if (!begun) return refused(begun.errors());
    if (*begun) return {PointOutcome::Begun, std::nullopt, {}};

    auto edit = protocol::editContact(*text, path, keysOf(*now, now->conditions[condition], front, setting));
    switch (edit.outcome) {
        case protocol::ContactEdit::Outcome::SetElsewhere:
            return {PointOutcome::SetElsewhere, std::nullopt, std::move(edit.error)};
        case protocol::ContactEdit::Outcome::Refused:
            return {PointOutcome::Refused, std::nullopt, std::move(edit.error)};
        case protocol::ContactEdit::Outcome::Changed:
        case protocol::ContactEdit::Outcome::Unchanged:
            break;
    }
    auto changed = readText(edit.text, path);
    if (!changed) return refused(changed.errors());
    if (!isRenderedBy(changed->conditions.at(condition).scene, front, setting))
        return refused({{.message = "no keys of its [scene.contact] make this setting", .file = path}});
    if (edit.text == *text) return {PointOutcome::SaidAlready, std::nullopt, {}};
    Error problem;
    switch (replaceFile(path, *text, edit.text, problem)) {
        case Replaced::Changed:
            return {PointOutcome::FileChanged, std::nullopt, {}};
        case Replaced::Failed:
            return {PointOutcome::Refused, std::nullopt, std::move(problem)};
        case Replaced::Done:
            break;
    }
    return {PointOutcome::Written, std::move(*changed), {}};
}

}  // namespace passung::run
