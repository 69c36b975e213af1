#include "tests/bench/force_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "core/tick/obstacle_query.h"
#include "core/tick/proxy.h"
#include "core/tick/step.h"
#include "core/tick/tick_state.h"
#include "study/person/simulated_person.h"
#include "study/protocol/protocol_reader.h"
#include "study/run/files/disk_store.h"
#include "study/run/files/known_names.h"
#include "study/run/loop_apparatus.h"
#include "tests/bench/stopwatch.h"
#include "tests/hard/figures.h"

namespace {

/// Time and number of the queries of the tick that runs.
struct QueryClock {
    bool running = false;
    double seconds = 0.0;
    int queries = 0;
};
QueryClock query_clock;

}  // namespace

// The linker sends the tick's calls of tick::queryObstacles to `timed` (CMakeLists.txt): the tick has no clock.
namespace passung::tick {
contact::QueryAnswer real(const HandModel& model, const ObstaclePoses& obstacles, const Pose& X_WS,
                          contact::QueryRequest request, contact::QueryWorkspace& workspace,
                          contact::ContactManifold& manifold, Lookout& lookout, bool known,
                          FewOfMany<ObstaclePush>* pushes) noexcept asm("__real_" PASSUNG_QUERY_SYMBOL);
contact::QueryAnswer timed(const HandModel& model, const ObstaclePoses& obstacles, const Pose& X_WS,
                           contact::QueryRequest request, contact::QueryWorkspace& workspace,
                           contact::ContactManifold& manifold, Lookout& lookout, bool known,
                           FewOfMany<ObstaclePush>* pushes) noexcept asm("__wrap_" PASSUNG_QUERY_SYMBOL);

contact::QueryAnswer timed(const HandModel& model, const ObstaclePoses& obstacles, const Pose& X_WS,
                           contact::QueryRequest request, contact::QueryWorkspace& workspace,
                           contact::ContactManifold& manifold, Lookout& lookout, bool known,
                           FewOfMany<ObstaclePush>* pushes) noexcept {
    if (!query_clock.running) return real(model, obstacles, X_WS, request, workspace, manifold, lookout, known, pushes);
    const bench::Stopwatch watch;
    const contact::QueryAnswer answer =
        real(model, obstacles, X_WS, request, workspace, manifold, lookout, known, pushes);
    query_clock.seconds += watch.seconds();
    ++query_clock.queries;
    return answer;
}
}  // namespace passung::tick

namespace passung::bench {

namespace {

constexpr double kUs = 1e6, kOverlapMark = 0.01;
constexpr double kFineTolerance = 5e-6;
constexpr const char* kFine = "5 um, both ways";
constexpr std::int64_t kTicks = 12'000, kFewTicks = 3'000;
constexpr std::size_t kMostContacts = 200;
constexpr const char* kParticipant = "P01";
constexpr std::uint64_t kSeed = 20260302;
constexpr std::int64_t kTrialsBefore = 26;  // practised

/// What it takes to read the clock.
double clockCost() {
    constexpr int kReads = 2000;
    const Stopwatch watch;
    double sum = 0.0;
    for (int i = 0; i < kReads; ++i) sum += watch.seconds();
    return sum > 0.0 ? watch.seconds() / kReads : 0.0;
}

/// One replay after another of the same readings.
class Replay {
public:
    Replay(const scene::Scene& scene, const std::vector<TickRecord>& records)
        : model_(tick::makeModel(scene)), records_(records) {}

    /// Time of every tick [us], its queries left out or not; ticks that are not in contact are NaN.
    std::vector<double> times(bool without_queries, int repetitions) {
        std::vector<double> best(records_.size(), kNotGiven);
        const double clock = clockCost();
        for (int repetition = 0; repetition < repetitions; ++repetition) {
            tick::TickState state = tick::makeState(model_);
            for (std::size_t i = 0; i < records_.size(); ++i) {
                query_clock = {.running = without_queries};
                const Stopwatch watch;
                const auto out = tick::step(model_, state, tick::readingOf(records_[i]));
                double time = watch.seconds() - clock;
                query_clock.running = false;
                if (without_queries) queries_ += query_clock.queries;
                // Each query read the clock twice, once of it within its own time.
                if (without_queries) time -= query_clock.seconds + clock * query_clock.queries;
                if (out.frame.contacts > 0) best[i] = std::fmin(best[i], kUs * time);
            }
        }
        return best;
    }

    /// Queries that were left out so far.
    int queries() const { return queries_; }

    /// Time of one motion for every tick in contact [us]; `contacts`: the mean number of them that it was solved under.
    std::vector<double> motionTimes(int repetitions, double& contacts) {
        std::vector<double> times;
        double sum = 0.0;
        tick::TickState state = tick::makeState(model_);
        const tick::HandModel& hand = model_.hands.front();
        tick::HandState& own = state.hands.front();
        tick::HandState wide = tick::makeHandState(hand);
        contact::ContactManifold nearest(kMostContacts);
        motion::Motion wanted_before = motion::Motion::Zero();
        const double clock = clockCost();
        for (const TickRecord& record : records_) {
            const auto out = tick::step(model_, state, tick::readingOf(record));
            const motion::Motion wanted = own.metric.between(own.X_WG, out.frame.X_WH);
            const motion::Motion before = std::exchange(wanted_before, wanted);
            if (out.frame.contacts == 0) continue;
            tick::TickFrame frame;
            tick::surveyContacts({hand, wide, wide, frame, wide}, own.X_WG);
            takeNearest(wide.manifold, nearest);
            const motion::Surroundings around{nearest, own.metric.at(own.X_WG), -hand.margins.keep};
            const motion::ConstrainedMotion last = motion::constrainMotion(before, around);
            std::vector<std::uint32_t> held;
            held.reserve(static_cast<std::size_t>(last.active));
            for (int i = 0; i < last.active; ++i)
                held.push_back(last.active_contacts[static_cast<std::size_t>(i)].contact);
            double best = kNotGiven;
            for (int repetition = 0; repetition < repetitions; ++repetition) {
                const Stopwatch watch;
                const motion::ConstrainedMotion motion = motion::constrainMotion(wanted, around, held);
                const double time = watch.seconds() - clock;
                if (motion.active > 0) best = std::fmin(best, kUs * time);
            }
            if (std::isnan(best)) continue;
            times.push_back(best);
            sum += static_cast<double>(nearest.size());
        }
        contacts = sum / static_cast<double>(std::max<std::size_t>(times.size(), 1));
        return times;
    }

private:
    static void takeNearest(const contact::ContactManifold& all, contact::ContactManifold& nearest) {
        std::vector<contact::ContactPoint> points(all.begin(), all.end());
        const std::size_t count = std::min(points.size(), kMostContacts);
        std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count), points.end(),
                         [](const auto& a, const auto& b) { return a.phi < b.phi; });
        nearest.clear();
        for (std::size_t i = 0; i < count; ++i) nearest.tryPush(points[i]);
    }

    tick::TickModel model_;
    const std::vector<TickRecord>& records_;
    int queries_ = 0;
};

std::vector<double> given(std::vector<double> values) {
    std::erase_if(values, [](double value) { return std::isnan(value); });
    return values;
}

Row rowOf(const char* method, const std::string& settings, bool ours, std::size_t samples) {
    return {.group = kForceGroup, .method = method, .settings = settings, .ours = ours, .samples = samples};
}

/// A god object and a penalty on the device path of `records`, as the hard cases run and judge a path; beside a god
/// object on closed forms at the ticks alone.
Result<Row> overlapRow(const std::string& settings, const scene::SceneSpec& god_object,
                       const scene::SceneSpec& by_penalty, const std::vector<TickRecord>& records) {
    const hard::Drive drive = [&](std::int64_t tick, const tick::TickOutput*) {
        return tick::readingOf(records[static_cast<std::size_t>(tick)]);
    };
    const auto deepest = [&](const scene::SceneSpec& scene) -> Result<double> {
        const auto run = hard::runScene(scene, drive, static_cast<std::int64_t>(records.size()));
        if (!run) return run.errors();
        return kUm * (god_object.contact.geometry == scene::Geometry::Field ? hard::deepestOverlap(*run)
                                                                            : hard::deepestShown(*run));
    };
    const auto ours = deepest(god_object), penalty = deepest(by_penalty);
    if (!ours) return ours.errors();
    if (!penalty) return penalty.errors();
    Row row = rowOf(kOverlapMethod, fmt::format("{}; {:.3g} um : {:.4g} um", settings, *ours, *penalty), true,
                    records.size());
    row.depth_um = summarise({*ours});
    row.figure = *penalty > 0.0 ? *ours / *penalty : std::numeric_limits<double>::infinity();
    row.figure_mark = kOverlapMark;
    return row;
}

/// The condition that differs from another one in how contact is computed alone, by the method; the first of those.
const plan::Condition* counterpart(const plan::StudyPlan& plan, const plan::Condition& condition,
                                   scene::ContactMethod method) {
    for (const plan::Condition& other : plan.conditions) {
        bool same = other.scene.contact.method == method;
        for (std::size_t f = 0; f < plan.factors.size(); ++f)
            same = same && (plan.factors[f].name == "method" || plan.factors[f].name == "geometry" ||
                            other.levels[f] == condition.levels[f]);
        if (same) return &other;
    }
    return nullptr;
}

}  // namespace

Result<std::vector<TickRecord>> recordTrial(const plan::StudyPlan& plan, const plan::Condition& condition,
                                            std::int64_t ticks) {
    const simulated::DeviceParams* device = simulated::findPreset(condition.device);
    if (device == nullptr) return Error{.message = "no such device preset", .value = condition.device};
    run::LoopApparatus apparatus(*device, person::personOf(plan.name, kParticipant, plan.seed), run::Clock::Virtual);
    const auto prepared = apparatus.prepare(condition, kSeed, kTrialsBefore);
    if (!prepared) return prepared.errors();
    std::vector<TickRecord> records(static_cast<std::size_t>(ticks));
    apparatus.start();
    for (std::size_t taken = 0; taken < records.size();) {
        apparatus.advance(1000);
        taken += apparatus.takeRecords(std::span(records).subspan(taken));
    }
    apparatus.stop();
    return records;
}

Result<std::vector<Row>> forceRows(const std::string& protocol, const Extent& extent) {
    std::vector<Row> rows;
    bool wanted = false;
    for (const char* method : {kQpMethod, kForceMethod, kTickMethod, kOverlapMethod})
        wanted = wanted || extent.wanted(kForceGroup, method);
    if (!wanted) return rows;
    const auto plan = protocol::readProtocol(protocol, run::knownDevices(), run::knownMeasures());
    if (!plan) return plan.errors();
    const auto store = run::openDiskStore();
    scene::PartCache parts(store.get());
    const std::int64_t ticks = extent.few_settings ? kFewTicks : kTicks;
    for (const plan::Condition& by_penalty : plan->conditions) {
        if (by_penalty.scene.contact.method != scene::ContactMethod::Penalty) continue;
        const plan::Condition* shipped = counterpart(*plan, by_penalty, scene::ContactMethod::GodObject);
        if (shipped == nullptr) return Error{.message = "has no god object beside this one", .value = by_penalty.name};
        std::string settings = by_penalty.name;
        for (const std::string part : {"penalty/", "/field"})
            if (const auto at = settings.find(part); at != std::string::npos) settings.erase(at, part.size());
        const auto trial = recordTrial(*plan, *shipped, ticks);
        if (!trial) return trial.errors();
        const auto as_shipped =
            overlapRow(settings + ", as the study has it", shipped->scene, by_penalty.scene, *trial);
        if (!as_shipped) return as_shipped.errors();
        rows.push_back(*as_shipped);
        // All other rows are of god objects on fields, with the cells that the penalty has.
        plan::Condition condition = by_penalty;
        condition.scene.contact.method = scene::ContactMethod::GodObject;
        condition.scene.contact.geometry = scene::Geometry::Field;
        const auto records = recordTrial(*plan, condition, ticks);
        if (!records) return records.errors();
        const auto scene = scene::buildScene(condition.scene, parts);
        if (!scene) return scene.errors();
        Replay replay(*scene, *records);
        const auto timed = [&](const char* method, std::vector<double> times) {
            Row row = rowOf(method, settings, true, times.size());
            if (!times.empty()) row.time_us = summarise(std::move(times));
            rows.push_back(row);
        };
        double contacts = 0.0;
        timed(kQpMethod, replay.motionTimes(extent.repetitions + 1, contacts));
        rows.back().contacts_mean = contacts;
        timed(kForceMethod, given(replay.times(true, extent.repetitions)));
        if (replay.queries() == 0) return Error{.message = "no query of the tick was seen: it has another name now"};
        timed(kTickMethod, given(replay.times(false, extent.repetitions)));
        scene::SceneSpec fine = condition.scene;
        fine.contact.cell = 0.0;
        fine.contact.tolerance = kFineTolerance;
        fine.contact.two_way = true;
        scene::SceneSpec fine_penalty = fine;
        fine_penalty.contact.method = scene::ContactMethod::Penalty;
        const auto overlap = overlapRow(settings + ", " + kFine, fine, fine_penalty, *records);
        if (!overlap) return overlap.errors();
        rows.push_back(*overlap);
        if (extent.few_settings) break;
    }
    return rows;
}

}  // namespace passung::bench
