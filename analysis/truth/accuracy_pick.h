#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "analysis/truth/accuracy_sweep.h"

namespace passung::truth {

/// A scene, and the ways in which contact is asked for there: of each count method, variant and two_way.
struct AskedScene {
    const scene::SceneSpec* scene;
    std::vector<scene::ContactSpec> contacts;
    std::function<bool(double spacing)> both_ways = {};  // is a contact that does not ask for both ways looked for both
                                                         // ways, with points so far apart [m]? Empty: never
};

/// Measures on this machine what contact.accuracy = "auto" may pick for `scenes` and `budgets` [s] of a query:
/// tolerances and spacings from coarse to fine, every mode, and node budgets where a query without one takes longer
/// than the least budget (only if every scene renders at the hand: a proxy stops where a query ended early, and may
/// never get into a bore); it ends with the first spacing at which every query takes longer than the largest. A scene's
/// time is the sum over its obstacles; of each setting count the slowest time and the largest error of any scene and
/// way of asking. Poses: see contactPath; times also at poses in between. `store`, if not null, keeps fields and points
/// from run to run. Errors: a part cannot be built, an obstacle (in two-way contact also a held part) without an
/// inside, a held part that never meets an obstacle.
/// @pre at least one budget, one scene, one contact of each, and an obstacle in each.
Result<std::vector<SettingCost>> measureCandidates(const std::vector<AskedScene>& scenes,
                                                   std::span<const double> budgets, const StepReport& report,
                                                   scene::BuildStore* store);

/// The time (p99) [s] of one of these settings on this machine, in the same scenes at the same poses. Errors: as above.
Result<double> timeOfSetting(const std::vector<AskedScene>& scenes, const AccuracySetting& setting,
                             scene::BuildStore* store);

/// The row with the smallest error (p99 of the depth) among those whose time (p99) fits `budget` [s]; the
/// faster of two that err alike.
std::optional<std::size_t> pickFinest(std::span<const SettingCost> rows, double budget);

}  // namespace passung::truth
