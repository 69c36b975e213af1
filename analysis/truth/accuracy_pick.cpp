#include "analysis/truth/accuracy_pick.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/assert.h"
#include "core/geometry/parallel.h"
#include "core/scene/scene.h"

namespace passung::truth {

namespace {

constexpr int kPaths = 4;
constexpr int kBetween = 6;         // timed poses from one pose of a path to its next
constexpr std::uint64_t kSeed = 1;  // the same poses for the same parts
constexpr int kRepetitions = 2;
constexpr std::array kTolerances{100e-6, 50e-6, 20e-6, 10e-6};  // [m]
// The coarser modes cost as much or more where a query reads point by point.
constexpr std::array kModes{field::FieldMode::Linear, field::FieldMode::Trilinear, field::FieldMode::Cubic};
constexpr std::array kNodes{300, 100};
constexpr double kPathShare = 0.4;  // of the work, as the progress shows it

/// One obstacle and the held part, with poses and their truth.
struct Pair {
    scene::PartSpec obstacle, held;
    double length = 0.0, lever = 0.0;  // of the held part, see PairTruth
    std::vector<JudgedPose> poses, two_way_poses;
    std::vector<Pose> timed;
};

/// What stands between the poses of each path too: a tick's query is asked along a motion.
std::vector<Pose> along(const std::vector<JudgedPose>& poses) {
    std::vector<Pose> timed;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Pose& from = poses[i].X_FS;
        timed.push_back(from);
        const auto nears = [&](std::size_t k) { return std::string_view(poses[k].phase) == kApproach; };
        if (i + 1 == poses.size() || (nears(i + 1) && !nears(i))) continue;  // the end of a path
        const Pose& to = poses[i + 1].X_FS;
        for (int k = 1; k < kBetween; ++k) {
            const double share = static_cast<double>(k) / kBetween;
            timed.push_back({from.q.slerp(share, to.q), from.p + share * (to.p - from.p)});
        }
    }
    return timed;
}

/// The same poses as contact is both ways.
Result<std::vector<JudgedPose>> judgedBothWays(const Pair& pair, scene::BuildStore* store) {
    const auto back = PairTruth::build(pair.held, pair.obstacle, store);
    if (!back) return back.errors();
    std::vector<JudgedPose> poses = pair.poses;
    geometry::parallelFor(poses.size(), [&](std::size_t i) {
        JudgedPose& pose = poses[i];
        pose.truth = bothWays(pose.truth, back->quicklyAt(pose.X_FS.inverse()), pose.X_FS);
    });
    return poses;
}

Result<Pair> makePair(const scene::PartSpec& obstacle, const scene::PartSpec& held, bool two_way,
                      const ProgressReport& report, scene::BuildStore* store) {
    const auto truth = PairTruth::build(obstacle, held, store);
    if (!truth) return truth.errors();
    Pair pair{.obstacle = obstacle,
              .held = held,
              .length = truth->length(),
              .lever = truth->lever(),
              .poses = contactPath(*truth, kPaths, kSeed, report, Truth::Quick),
              .two_way_poses = {},
              .timed = {}};
    if (pair.poses.empty())
        return Error{.message = "the held part never meets it, so that no accuracy can be picked",
                     .key = "part " + obstacle.name};
    pair.timed = along(pair.poses);
    if (!two_way) return pair;
    auto both = judgedBothWays(pair, store);
    if (!both) return both.errors();
    pair.two_way_poses = std::move(*both);
    return pair;
}

template <class Join>
void join(Spread& into, const Spread& other, const Join& joined) {
    into.mean = joined(into.mean, other.mean);
    into.median = joined(into.median, other.median);
    into.p99 = joined(into.p99, other.p99);
    into.max = joined(into.max, other.max);
}

/// Of the same setting elsewhere: the larger errors, and `joined` times.
template <class Join>
void merge(SettingCost& row, const SettingCost& other, const Join& joined) {
    join(row.time, other.time, joined);
    for (Spread SettingCost::*error :
         {&SettingCost::depth, &SettingCost::force, &SettingCost::direction, &SettingCost::torque})
        join(row.*error, other.*error, [](double a, double b) { return std::fmax(a, b); });
    row.points = std::max(row.points, other.points);
    row.field_bytes += other.field_bytes;
    row.shell_bytes = std::max(row.shell_bytes, other.shell_bytes);
}

/// All scenes, asked one setting after the other.
class Candidates {
public:
    explicit Candidates(scene::BuildStore* store) : store_(store), parts_(store) {}

    Result<Done> addScene(const AskedScene& asked, const ProgressReport& report) {
        const auto& parts = asked.scene->parts;
        const auto held = std::find_if(parts.begin(), parts.end(), [](const auto& part) { return part.held; });
        const bool two_way = std::any_of(asked.contacts.begin(), asked.contacts.end(),
                                         [](const scene::ContactSpec& contact) { return contact.two_way; });
        Scene scene{{}, asked.contacts, asked.both_ways};
        for (const scene::PartSpec& part : parts) {
            if (part.held) continue;
            auto pair = makePair(part, *held, two_way, report, store_);
            if (!pair) return pair.errors();
            scene.pairs.push_back(std::move(*pair));
        }
        PASSUNG_ASSERT(!scene.pairs.empty());
        scenes_.push_back(std::move(scene));
        return Done{};
    }

    /// Longest side of a held part [m].
    double length() const {
        double length = 0.0;
        for (const Scene& scene : scenes_)
            for (const Pair& pair : scene.pairs) length = std::max(length, pair.length);
        return length;
    }

    Result<SettingCost> measure(const AccuracySetting& setting) {
        std::optional<SettingCost> all;
        for (Scene& scene : scenes_) {
            for (scene::ContactSpec contact : scene.contacts) {
                if (!contact.two_way && scene.both_ways) contact.two_way = scene.both_ways(setting.spacing);
                const auto sum = measureScene(setting, contact, scene.pairs);
                if (!sum) return sum.errors();
                if (all)
                    merge(*all, *sum, [](double a, double b) { return std::fmax(a, b); });
                else
                    all = *sum;
            }
        }
        return *all;
    }

private:
    struct Scene {
        std::vector<Pair> pairs;
        std::vector<scene::ContactSpec> contacts;
        std::function<bool(double)> both_ways;
    };

    Result<SettingCost> measureScene(const AccuracySetting& setting, const scene::ContactSpec& contact,
                                     std::vector<Pair>& pairs) {
        std::optional<SettingCost> sum;
        for (Pair& pair : pairs) {
            if (contact.two_way && pair.two_way_poses.empty()) {
                auto both = judgedBothWays(pair, store_);
                if (!both) return both.errors();
                pair.two_way_poses = std::move(*both);
            }
            const auto get = [&](const scene::PartSpec& part) {
                return parts_.get(part, {.field = !part.held || contact.two_way,
                                         .shell = part.held || contact.two_way,
                                         .tolerance = setting.tolerance,
                                         .spacing = setting.spacing});
            };
            const auto field = get(pair.obstacle), shell = get(pair.held);
            if (!field) return field.errors();
            if (!shell) return shell.errors();
            const SettingCost row =
                measureSetting(setting, contact, *field, *shell, contact.two_way ? pair.two_way_poses : pair.poses,
                               pair.timed, kRepetitions, pair.lever);
            if (sum)
                merge(*sum, row, [](double a, double b) { return a + b; });
            else
                sum = row;
        }
        return *sum;
    }

    scene::BuildStore* store_;
    scene::PartCache parts_;
    std::vector<Scene> scenes_;
};

}  // namespace

Result<std::vector<SettingCost>> measureCandidates(const std::vector<AskedScene>& scenes,
                                                   std::span<const double> budgets, const StepReport& report,
                                                   scene::BuildStore* store) {
    Candidates candidates(store);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const auto added = candidates.addScene(scenes[i], [&](double share) {
            report("what is true along contact paths",
                   kPathShare * (static_cast<double>(i) + share) / static_cast<double>(scenes.size()));
        });
        if (!added) return added.errors();
    }
    std::vector<SettingCost> rows;
    const std::vector<double> spacings = defaultSpacings(candidates.length());
    const auto [least, most] = std::minmax_element(budgets.begin(), budgets.end());
    const bool budgeted = std::all_of(scenes.begin(), scenes.end(), [](const AskedScene& scene) {
        return std::all_of(scene.contacts.begin(), scene.contacts.end(),
                           [](const scene::ContactSpec& contact) { return contact.rendersAtHand(); });
    });
    for (std::size_t i = 0; i < spacings.size(); ++i) {
        bool fits = false;
        for (std::size_t k = 0; k < kTolerances.size(); ++k) {
            const double steps = static_cast<double>(i * kTolerances.size() + k);
            report(fmt::format("field to {:g} µm, points {:g} mm apart", 1e6 * kTolerances[k], 1e3 * spacings[i]),
                   kPathShare + (1.0 - kPathShare) * steps / static_cast<double>(spacings.size() * kTolerances.size()));
            for (const field::FieldMode mode : kModes) {
                auto row = candidates.measure({mode, kTolerances[k], spacings[i], 0});
                if (!row) return row.errors();
                rows.push_back(*row);
                fits = fits || row->time.p99 <= *most;
                for (const int nodes : kNodes) {
                    if (!budgeted || rows.back().time.p99 <= *least) break;
                    row = candidates.measure({mode, kTolerances[k], spacings[i], nodes});
                    if (!row) return row.errors();
                    rows.push_back(*row);
                }
            }
        }
        if (!fits) break;
    }
    report("", 1.0);
    return rows;
}

Result<double> timeOfSetting(const std::vector<AskedScene>& scenes, const AccuracySetting& setting,
                             scene::BuildStore* store) {
    Candidates candidates(store);
    for (const AskedScene& scene : scenes)
        if (const auto added = candidates.addScene(scene, [](double) {}); !added) return added.errors();
    const auto row = candidates.measure(setting);
    if (!row) return row.errors();
    return row->time.p99;
}

std::optional<std::size_t> pickFinest(std::span<const SettingCost> rows, double budget) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!(rows[i].time.p99 <= budget) || std::isnan(rows[i].depth.p99)) continue;
        const auto rank = [&](std::size_t k) { return std::pair(rows[k].depth.p99, rows[k].time.p99); };
        if (!best || rank(i) < rank(*best)) best = i;
    }
    return best;
}

}  // namespace passung::truth
