#include "study/run/machine/tick_front.h"

#include <algorithm>
#include <cmath>

#include "analysis/truth/accuracy_tick_tables.h"
#include "core/scene/contact_geometry.h"
#include "study/protocol/felt_features.h"
#include "study/run/files/watched_store.h"

namespace passung::run {

namespace {

constexpr double kPathShare = 0.1;   // of the work
constexpr double kRounding = 1e-12;  // relative: what a value in a file's units may lose on its way to SI and back

bool same(double a, double b) { return std::abs(a - b) <= kRounding * std::max(std::abs(a), std::abs(b)); }

/// The settings that a study may have: both ways where the points of one would miss something, and none with which a
/// feature of the parts would not be felt at all.
truth::TickSettings feltSettings(const scene::SceneSpec& scene, scene::BuildStore* builds) {
    truth::TickSettings all = truth::tickSettings(scene, {});
    protocol::PartGeometries geometries(builds);
    std::vector<truth::TickSetting> felt;
    for (truth::TickSetting& setting : all.settings) {
        if (setting.geometry == scene::Geometry::Field) {
            scene::SceneSpec asked = scene;
            asked.contact.geometry = setting.geometry;
            asked.contact.method = setting.method;
            asked.contact.spacing = setting.field.spacing;
            asked.contact.cell = truth::cellOf(scene.contact, setting);
            asked.contact.tolerance = setting.field.tolerance;
            if (!setting.two_way) setting.two_way = !protocol::oneWayFeelsAll(asked, geometries);
            asked.contact.two_way = setting.two_way;
            if (!protocol::feelsEverything(asked, geometries)) {
                all.left_out.push_back(truth::settingText(setting) + ": something of the parts would not be felt");
                continue;
            }
        }
        felt.push_back(setting);
    }
    all.settings = std::move(felt);
    return all;
}

}  // namespace

Result<TickFront> measureFront(const plan::Condition& condition, const truth::TickEffort& effort,
                               const FrontWatch& watch, scene::BuildStore* builds) {
    FrontProgress now;
    const auto tell = [&] {
        if (!watch(now)) throw MeasuringCancelled();
    };
    WatchedStore store(builds);
    store.begin(1, [&](double) {  // each piece that is built is a moment to ask
        tell();
        return true;
    });
    tell();
    scene::PartCache parts(&store);
    auto path = handPath(condition, parts, [&](double done) {
        now.share = kPathShare * done;
        tell();
    });
    if (!path) return path.errors();
    auto all = feltSettings(condition.scene, &store);
    if (all.settings.empty())
        return Error{.message = "no setting fits: " + (all.left_out.empty() ? "" : all.left_out.front()),
                     .key = "condition",
                     .value = condition.name};
    const auto report = [&](const std::string& what, double done) {
        const auto named = std::find_if(all.settings.begin(), all.settings.end(),
                                        [&](const auto& each) { return truth::settingText(each) == what; });
        now.setting = named == all.settings.end() ? nullptr : &*named;
        now.cell = now.setting != nullptr ? truth::cellOf(condition.scene.contact, *now.setting) : 0.0;
        now.share = kPathShare + (1.0 - kPathShare) * done;
        tell();
    };
    auto measured = truth::measureTicks(condition.scene, path->X_WH, all.settings, effort, report, &store);
    if (!measured) return measured.errors();
    return TickFront{condition.scene.contact, path->origin, path->X_WH.size(), *std::move(measured),
                     std::move(all.left_out)};
}

double cellOf(const TickFront& front, const truth::TickSetting& setting) { return truth::cellOf(front.own, setting); }

bool isRenderedBy(const scene::SceneSpec& scene, const TickFront& front, const truth::TickSetting& setting) {
    const scene::ContactSpec& contact = scene.contact;
    if (contact.method != setting.method || scene::geometryOf(scene).geometry != setting.geometry) return false;
    if (setting.geometry != scene::Geometry::Field) return true;
    const double cell = cellOf(front, setting);
    return same(contact.cell, cell) && (cell > 0.0 || same(contact.tolerance, setting.field.tolerance)) &&
           same(contact.spacing, setting.field.spacing) && contact.mode == setting.field.mode &&
           contact.budget_nodes == setting.field.budget_nodes && contact.two_way == setting.two_way;
}

}  // namespace passung::run
