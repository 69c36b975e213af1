#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <ostream>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/motion/constrained_motion.h"
#include "core/shape/shape.h"
#include "core/tick/god_object.h"
#include "tests/hard/case.h"
#include "tests/hard/figures.h"
#include "tests/hard/found.h"
#include "tests/hard/found_onlooker.h"
#include "tests/support/length.h"

namespace passung::hard {
namespace {

/// A case and one of the methods that have to hold its mark.
struct Hold {
    const Case* what;
    scene::ContactMethod method;
    const char* method_name;

    std::string name() const { return std::string(what->name) + "_" + method_name; }
};

void PrintTo(const Hold& hold, std::ostream* out) { *out << hold.name(); }

/// By default every case is run with one of its methods, in turns and the first of its seeds, and planted faults are
/// tried with every sixteenth; PASSUNG_LONG=1: all of them. The size of each is another matter: fullSize().
bool everything() { return test::atFullLength() || fullSize(); }

std::vector<Hold> holds() {
    std::vector<Hold> all;
    std::size_t turn = 0;
    for (const Case& c : cases()) {
        std::vector<Hold> of_case;
        for (const auto& [method, name] : methods())
            if (applies(c, method)) of_case.push_back({&c, method, name});
        if (everything())
            all.insert(all.end(), of_case.begin(), of_case.end());
        else if (!of_case.empty())
            all.push_back(of_case[turn++ % of_case.size()]);
    }
    return all;
}

class Hard : public testing::TestWithParam<Hold> {};

TEST_P(Hard, CaseHoldsItsMark) {
    // Truth: closed form or independent program (FCL), as the case's judgement says.
    const auto& [c, method, name] = GetParam();
    Case some = *c;
    if (!everything()) some.seeds = 1;
    const auto measured = measure(some, method, fullSize());
    ASSERT_TRUE(measured) << toString(measured.errors().front());
    std::printf("%s", describe(some, name, *measured).c_str());
    const Judgement& found = measured->judgement;
    EXPECT_LE(found.value, c->mark) << c->unit;
    EXPECT_EQ(found.broken, "");
}

INSTANTIATE_TEST_SUITE_P(Table, Hard, testing::ValuesIn(holds()), [](const auto& hold) { return hold.param.name(); });

/// A found case and one of the methods.
struct FoundWith {
    const Found* what;
    scene::ContactMethod method;
    const char* method_name;
};

void PrintTo(const FoundWith& found, std::ostream* out) { *out << found.what->name; }

/// By default each with one of its methods, in turns.
std::vector<FoundWith> foundOnes() {
    std::vector<FoundWith> all;
    std::size_t turn = 0;
    for (const Found& found : foundCases()) {
        std::vector<FoundWith> of_case;
        for (const auto& [method, name] : methods())
            if ((found.methods >> static_cast<int>(method)) & 1u) of_case.push_back({&found, method, name});
        if (everything())
            all.insert(all.end(), of_case.begin(), of_case.end());
        else
            all.push_back(of_case[turn++ % of_case.size()]);
    }
    return all;
}

class FoundCase : public testing::TestWithParam<FoundWith> {};

TEST_P(FoundCase, IsNoLongerFound) {
    // Truth: triangle against triangle as they were made (mesh_crossing.h), or dense points and exact distances
    // (dense_overlap.h), at every tick and on the way between. What is missed of grain and time is printed.
    const auto& [found, method, name] = GetParam();
    const auto measured = measureFound(*found, method, fullSize(), 1);  // no time is judged here
    ASSERT_TRUE(measured) << toString(measured.errors().front());
    std::printf("%s", describe(*found, name, *measured).c_str());
    for (const Figure& figure : measured->figures)
        if (figure.holds) {
            EXPECT_LE(figure.value, figure.mark) << figure.name;
        }
}

INSTANTIATE_TEST_SUITE_P(Table, FoundCase, testing::ValuesIn(foundOnes()), [](const auto& found) {
    return std::string(found.param.what->name) + "_" + found.param.method_name;
});

TEST(HardCases, PenaltyFallsThroughSheetAndThinPlate) {
    // Truth: independent program (FCL): forces from the overlap alone hold nothing back, so that what these cases count
    // is there to be found.
    for (const char* name : {"sheet_strokes", "sheet_edge", "sheet_turning", "a11_thin_plate"}) {
        const Case* c = findCase(name);
        ASSERT_NE(c, nullptr);
        Case some = *c;
        some.seconds = 1.0;
        const auto measured = measure(some, scene::ContactMethod::Penalty, false);
        ASSERT_TRUE(measured);
        std::printf("%s", describe(some, "penalty", *measured).c_str());
        EXPECT_GT(measured->judgement.value, 50.0);
    }
}

using Spec = scene::SceneSpec;

Vec3 within(const Vec3& v, double limit) { return v.norm() > limit ? Vec3(limit * v.normalized()) : v; }

/// The spring's wrench for a proxy at `X_WG` [m].
void pullTo(const Spec& spec, Tick& t, const Pose& X_WG) {
    t.proxy = X_WG;
    t.sent.force = within(spec.contact.stiffness * (X_WG.p - t.device.p), spec.limits.max_force);
    t.sent.torque = within(spec.contact.rotational_stiffness * rotationVector(X_WG.q * t.device.q.conjugate()),
                           spec.limits.max_torque);
}

void neverMoves(const Spec& spec, std::vector<Tick>& ticks) {
    for (Tick& t : ticks) pullTo(spec, t, heldPart(spec).X_WP);
}

void feelsNothing(const Spec&, std::vector<Tick>& ticks) {
    for (Tick& t : ticks) t.sent = t.commanded = Wrench{};
}

void isTheDevice(const Spec&, std::vector<Tick>& ticks) {
    for (Tick& t : ticks) t.proxy = t.device, t.sent = t.commanded = Wrench{};
}

void turnsTooHard(const Spec& spec, std::vector<Tick>& ticks) {
    for (Tick& t : ticks) t.commanded.torque = Vec3(0, 0, 1.01 * spec.limits.max_torque);
}

struct Fault {
    const char* name;
    void (*plant)(const Spec&, std::vector<Tick>&);
};

TEST(HardCases, NoMarkIsHeldByAProxyThatDoesNotFollowOrByWhatIsNotFelt) {
    // Truth: invariant. Runs of the god object with a planted fault: most overlap nothing and cross nothing.
    constexpr std::array kFaults{Fault{"never moves", neverMoves}, Fault{"feels nothing", feelsNothing},
                                 Fault{"is the device", isTheDevice}, Fault{"turns too hard", turnsTooHard}};
    std::size_t place = 0;
    for (const Case& c : cases()) {
        if (c.compute != nullptr || !applies(c, scene::ContactMethod::GodObject)) continue;
        if (place++ % 16 != 0 && !everything()) continue;
        std::array<Judgement, kFaults.size()> found;
        std::array<bool, kFaults.size()> seen{};
        for (int seed = 0; seed < c.seeds; ++seed) {
            if (std::all_of(seen.begin(), seen.end(), [](bool one) { return one; })) break;
            const auto run = runCase(c, scene::ContactMethod::GodObject, static_cast<std::uint64_t>(seed), false);
            ASSERT_TRUE(run);
            for (std::size_t i = 0; i < kFaults.size(); ++i) {
                if (seen[i]) continue;
                auto spoilt = *run;
                kFaults[i].plant(run->spec, spoilt.ticks);
                // A broken rule is found in milliseconds, the number of most cases in seconds.
                found[i].broken = brokenRule(spoilt);
                if (found[i].broken.empty()) found[i] = judgeRun(c, spoilt);
                seen[i] = !found[i].broken.empty() || !(found[i].value <= c.mark);
            }
        }
        for (std::size_t i = 0; i < kFaults.size(); ++i) {
            std::printf("%-20s %-22s %s\n", c.name, kFaults[i].name,
                        found[i].broken.empty() ? (std::to_string(found[i].value) + ' ' + c.unit).c_str()
                                                : found[i].broken.c_str());
            EXPECT_TRUE(seen[i]) << c.name << ": a proxy that " << kFaults[i].name;
        }
    }
}

/// What geometry says of a found case's run where each tick's output was spoilt, and the obstacle stands higher [m].
Seen seenOf(const char* name, const std::function<void(tick::TickOutput&)>& spoil, double higher = 0.0) {
    const auto found = std::find_if(foundCases().begin(), foundCases().end(),
                                    [&](const Found& one) { return one.name == std::string(name); });
    auto scene = found->make(0);
    if (!scene) return {};
    scene->spec.contact.method = scene::ContactMethod::GodObject;
    FoundScene judged = *scene;
    for (Vec3& v : judged.obstacle.vertices) v.z() += higher;
    for (scene::PartSpec& part : judged.spec.parts)
        if (!part.held) part.X_WP.p.z() += higher;
    FoundOnlooker looks(*found, judged, true);
    const auto run =
        runScene(scene->spec, driveOf(*scene), 1200, [&](const auto& model, const auto& state, const auto& output) {
            tick::TickOutput spoilt = output;
            spoil(spoilt);
            looks.look(model, state, spoilt);
        });
    return run ? looks.seen() : Seen{};
}

TEST(HardCases, NoFoundMarkIsHeldByAProxyThatIsALittleOff) {
    // Truth: invariant. Sound runs on triangles and on shapes with a planted fault; the gap that is held is 1 um.
    const auto sound = [](tick::TickOutput&) {};
    const auto is_the_device = [](tick::TickOutput& out) { out.X_WG = out.frame.X_WH; };
    const Seen triangles = seenOf("fin_mesh", sound), shapes = seenOf("fin_cell", sound);
    EXPECT_EQ(triangles.crossings + triangles.between + triangles.gaps_too_high + triangles.hanging, 0u);
    EXPECT_GT(triangles.gaps, 10u);
    EXPECT_LE(std::max(shapes.overlap, shapes.overlap_between), 1e-7);
    EXPECT_GT(seenOf("fin_mesh", is_the_device).crossings, 100u);
    EXPECT_GT(seenOf("fin_cell", is_the_device).overlap, 1e-4);
    const Seen in_triangles = seenOf("fin_mesh", sound, 2e-6), in_shapes = seenOf("fin_cell", sound, 3e-7);
    EXPECT_GT(in_triangles.crossings, 100u);
    EXPECT_GT(in_triangles.between, 100u);
    EXPECT_GT(in_shapes.overlap, 1e-7);
    EXPECT_GT(in_shapes.overlap_between, 1e-7);
    EXPECT_GT(seenOf("fin_mesh", [](tick::TickOutput& out) { out.frame.proxy_gap *= 1.05; }).gaps_too_high, 10u);
    EXPECT_GT(seenOf("fin_mesh", [](tick::TickOutput& out) { out.frame.proxy_gap *= 0.5; }).gaps_loose, 10u);
    EXPECT_GT(seenOf("fin_mesh", [](tick::TickOutput& out) { out.X_WG.p.z() += 1e-3; }).hanging, 10u);
    EXPECT_GT(seenOf("fin_mesh", [](tick::TickOutput& out) { out.X_WG.p.z() = NAN; }).not_finite, 1000u);
}

void pushesHarder(const Spec&, std::vector<Tick>& ticks) {
    for (Tick& t : ticks) t.sent.force *= 1.02;
}

void pushesAskew(const Spec&, std::vector<Tick>& ticks) {
    for (Tick& t : ticks) t.sent.force = rotationFromVector(Vec3(0.01, 0.01, 0.01)) * t.sent.force;
}

void turnsBesides(const Spec& spec, std::vector<Tick>& ticks) {
    double reach = 0.0;
    for (const Vec3& v : shape::tessellate(std::get<shape::Shape>(heldPart(spec).geometry), 1e-5).vertices)
        reach = std::max(reach, v.norm());
    for (Tick& t : ticks) t.sent.torque += 0.02 * reach * t.sent.force;
}

void givesBackMore(const Spec&, std::vector<Tick>& ticks) {
    for (std::size_t i = 1; i < ticks.size(); ++i)
        if (ticks[i].device.p.z() > ticks[i - 1].device.p.z()) ticks[i].sent.force *= 1.01;
}

TEST(HardCases, NoClosedFormOfThePenaltyIsHeldByAWrenchThatIsALittleWrong) {
    // Truth: invariant. Runs of the penalty, which hold their marks, with a planted fault beyond these.
    constexpr std::array kWrong{Fault{"pushes harder", pushesHarder}, Fault{"pushes askew", pushesAskew},
                                Fault{"turns besides", turnsBesides}};
    constexpr std::array kActive{Fault{"gives back more", givesBackMore}};
    const auto plant = [](const char* name, std::span<const Fault> faults) {
        const Case* c = findCase(name);
        ASSERT_NE(c, nullptr);
        const auto run = runCase(*c, scene::ContactMethod::Penalty, 0, false);
        ASSERT_TRUE(run);
        const Judgement sound = judgeRun(*c, *run);
        EXPECT_TRUE(sound.broken.empty() && sound.value <= c->mark) << name << ": " << sound.value << sound.broken;
        for (const Fault& fault : faults) {
            auto spoilt = *run;
            fault.plant(run->spec, spoilt.ticks);
            const Judgement found = judgeRun(*c, spoilt);
            EXPECT_TRUE(!found.broken.empty() || found.value > c->mark) << name << ": a wrench that " << fault.name;
        }
    };
    for (const char* name :
         {"a1_submerged_body", "a2_sphere_plane", "a3_box_plane", "a4_sphere_sphere", "a5_peg_offset"})
        plant(name, kWrong);
    plant("a13_cycle", kActive);
}

TEST(HardCases, NoTickBeyondACapPasses) {
    // Truth: invariant. A sound run with one tick at or beyond each cap; and pins of which one is 10 um too low.
    const Case* c = findCase("hundred_patches");
    ASSERT_NE(c, nullptr);
    const auto run = runCase(*c, scene::ContactMethod::GodObject, 0, false);
    ASSERT_TRUE(run);
    EXPECT_EQ(judgeRun(*c, *run).broken, "");
    const auto broken = [&](const auto& plant) {
        auto spoilt = *run;
        plant(spoilt.ticks[400]);
        return brokenRule(spoilt);
    };
    EXPECT_NE(broken([](Tick& t) { t.nodes = 2'000'000'000; }).find("nodes"), std::string::npos);
    EXPECT_NE(broken([](Tick& t) { t.contacts = 2'000'000'000; }).find("points"), std::string::npos);
    EXPECT_NE(broken([](Tick& t) { t.iterations = tick::kSweeps + 1; }).find("sub-steps"), std::string::npos);
    EXPECT_NE(broken([](Tick& t) { t.rows = motion::kMaxIterations; }).find("took up"), std::string::npos);
    EXPECT_NE(broken([](Tick& t) { t.turns = 1; }).find("turns"), std::string::npos);
    auto spoilt = *run;
    spoilt.solids.parts.back().X_WP.p.z() -= 10e-6;
    EXPECT_EQ(judgeRun(*c, spoilt).broken, "99 of 100 pins touched at once");
}

}  // namespace
}  // namespace passung::hard
