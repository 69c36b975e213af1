#include "tests/bench/many_part_rows.h"

#include <fmt/format.h>
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include "core/tick/step.h"
#include "core/tick/tick_state.h"
#include "study/protocol/protocol_reader.h"
#include "study/run/files/disk_store.h"
#include "study/run/files/known_names.h"
#include "tests/bench/force_rows.h"
#include "tests/bench/stopwatch.h"

namespace passung::bench {

namespace {

constexpr double kUs = 1e6;
constexpr std::int64_t kTicks = 12'000, kFewTicks = 2'000;
constexpr std::size_t kMemoryTicks = 2'000;
constexpr double kBox = 0.02, kPitch = 0.03, kNearest = 0.12;  // [m]
constexpr double kFewMark = 3.0, kManyMark = 20.0;             // [us]
constexpr double kMemoryMark = 2.0;                            // [MB]
constexpr std::size_t kFew = 200, kMany = 10'000;

struct Kind {
    const char* name;
    scene::Geometry geometry;
};
constexpr std::array kKinds{Kind{"closed form", scene::Geometry::ClosedForm}, Kind{"surface", scene::Geometry::Surface},
                            Kind{"field", scene::Geometry::Field}};

/// `scene` with so many boxes more, in squares around the origin, from the inside out.
scene::SceneSpec among(scene::SceneSpec scene, std::size_t boxes) {
    const std::size_t all = scene.parts.size() + boxes;
    for (int ring = 1; scene.parts.size() < all; ++ring)
        for (int i = -ring; i <= ring; ++i)
            for (int k = -ring; k <= ring; ++k) {
                const Vec3 p(kPitch * i, kPitch * k, 0.0);
                if (std::max(std::abs(i), std::abs(k)) != ring || p.norm() < kNearest || scene.parts.size() == all)
                    continue;
                scene.parts.push_back({.name = fmt::format("box {}", scene.parts.size()),
                                       .geometry = shape::Shape{shape::Box{kBox, kBox, kBox}},
                                       .X_WP = {Quat::Identity(), p}});
            }
    return scene;
}

/// One of the scenes, and the fastest time of every tick in it [us].
struct Timed {
    Timed(const scene::Scene& of, std::size_t ticks)
        : scene(of), model(tick::makeModel(scene)), best(ticks, kNotGiven) {}

    void run(const std::vector<TickRecord>& records) {
        tick::TickState state = tick::makeState(model);
        for (std::size_t i = 0; i < records.size(); ++i) {
            const Stopwatch watch;
            tick::step(model, state, tick::readingOf(records[i]));
            best[i] = std::fmin(best[i], kUs * watch.seconds());
        }
    }

    scene::Scene scene;
    tick::TickModel model;
    std::vector<double> best;
};

double residentBytes() {
    malloc_trim(0);
    long size = 0, resident = 0;
    std::FILE* const file = std::fopen("/proc/self/statm", "r");
    if (file == nullptr) return kNotGiven;
    const bool read = std::fscanf(file, "%ld %ld", &size, &resident) == 2;
    std::fclose(file);
    return read ? static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) : kNotGiven;
}

/// What a process of its own holds in memory after some ticks in the scene [bytes]; NaN if there is none.
double memoryOf(const scene::SceneSpec& spec, const std::vector<TickRecord>& records) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return kNotGiven;
    const pid_t child = fork();
    if (child == 0) {
        double bytes = kNotGiven;
        scene::PartCache parts;
        if (const auto scene = scene::buildScene(spec, parts)) {
            const tick::TickModel model = tick::makeModel(*scene);
            tick::TickState state = tick::makeState(model);
            for (std::size_t i = 0; i < std::min(kMemoryTicks, records.size()); ++i)
                tick::step(model, state, tick::readingOf(records[i]));
            bytes = residentBytes();
        }
        const bool told = write(ends[1], &bytes, sizeof bytes) == sizeof bytes;
        _exit(told ? 0 : 1);
    }
    close(ends[1]);
    double bytes = kNotGiven;
    if (child < 0 || read(ends[0], &bytes, sizeof bytes) != sizeof bytes) bytes = kNotGiven;
    close(ends[0]);
    if (child > 0) waitpid(child, nullptr, 0);
    return bytes;
}

Row rowOf(const Kind& kind, std::string settings, std::size_t samples) {
    return {
        .group = kPartsGroup, .method = kind.name, .settings = std::move(settings), .ours = true, .samples = samples};
}

/// The study's god object with the least play on the stiffest wall.
const plan::Condition* conditionOf(const plan::StudyPlan& plan) {
    const plan::Condition* found = nullptr;
    for (const plan::Condition& condition : plan.conditions)
        if (condition.scene.contact.method == scene::ContactMethod::GodObject) found = &condition;
    return found;
}

}  // namespace

Result<std::vector<Row>> manyPartRows(const std::string& protocol, const Extent& extent) {
    std::vector<Row> rows;
    if (std::none_of(kKinds.begin(), kKinds.end(),
                     [&](const Kind& kind) { return extent.wanted(kPartsGroup, kind.name); }))
        return rows;
    const auto plan = protocol::readProtocol(protocol, run::knownDevices(), run::knownMeasures());
    if (!plan) return plan.errors();
    const plan::Condition* condition = conditionOf(*plan);
    if (condition == nullptr) return Error{.message = "has no condition with a god object", .value = protocol};
    const auto records = recordTrial(*plan, *condition, extent.few_settings ? kFewTicks : kTicks);
    if (!records) return records.errors();
    const auto store = run::openDiskStore();
    scene::PartCache parts(store.get());
    for (const Kind& kind : kKinds) {
        if (!extent.wanted(kPartsGroup, kind.name)) continue;
        scene::SceneSpec alone = condition->scene;
        alone.contact.geometry = kind.geometry;
        std::vector<std::size_t> counts{0, kFew, kMany};
        if (extent.few_settings) counts.pop_back();
        std::vector<std::unique_ptr<Timed>> scenes;  // each borrows its own scene
        for (const std::size_t boxes : counts) {
            const auto scene = scene::buildScene(among(alone, boxes), parts);
            if (!scene) return scene.errors();
            scenes.push_back(std::make_unique<Timed>(*scene, records->size()));
        }
        // By turns, so that all have what the machine does beside them.
        for (int repetition = 0; repetition < extent.repetitions; ++repetition)
            for (const auto& scene : scenes) scene->run(*records);
        const Times before = summarise(scenes.front()->best);
        for (std::size_t i = 0; i < counts.size(); ++i) {
            Row row = rowOf(kind, fmt::format("time, {} more parts", counts[i]), records->size());
            row.time_us = summarise(scenes[i]->best);
            if (i > 0) {
                row.figure = std::max(row.time_us.median - before.median, row.time_us.p999 - before.p999);
                row.figure_mark = counts[i] == kFew ? kFewMark : kManyMark;
                row.figure_unit = "us";
            }
            rows.push_back(row);
        }
        scenes.clear();
        Row row = rowOf(kind, fmt::format("memory, {} equal boxes more", kFew), 1);
        row.figure = 1e-6 * (memoryOf(among(alone, kFew), *records) - memoryOf(alone, *records));
        row.memory_MB = row.figure;
        row.figure_mark = kMemoryMark;
        row.figure_unit = "MB";
        rows.push_back(row);
    }
    return rows;
}

}  // namespace passung::bench
