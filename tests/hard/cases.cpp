#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/hard/case.h"
#include "tests/hard/device_cases.h"
#include "tests/hard/figures.h"
#include "tests/hard/paths.h"
#include "tests/hard/truth_cases.h"

namespace passung::hard {

namespace {

using scene::SceneSpec;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Pose worldOf(const SceneSpec& spec) { return fixedPart(spec).X_WP; }

/// The whole scene turned and moved at random. (Fields turn with their parts: relaid.h.)
void anywhere(SceneSpec& spec, std::uint64_t seed) {
    Random random(streamSeed("hard", "", "", "world", seed));
    const auto three = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
    const Pose X{Quat(random.normal(), random.normal(), random.normal(), random.normal()).normalized(),
                 0.013 * three()};
    for (scene::PartSpec& part : spec.parts) part.X_WP = X * part.X_WP;
}

// ---- paths ----------------------------------------------------------------------------------------------------------

/// Strokes through a sheet at 0.1 to 5 m/s, from both sides; `turning`: while the tool spins.
Drive strokes(const SceneSpec& spec, std::uint64_t seed, bool turning) {
    Random random(streamSeed("hard", "", "", "strokes", seed));
    Walk walk(at(0, 0, 12));
    double side = 1.0;
    const auto turned = [&](double share) {
        const double a = share * std::numbers::pi;
        return Vec3(random.uniform(-a, a), random.uniform(-a, a), random.uniform(-a, a));
    };
    for (int k = 0; k < 4000; ++k) {
        const double speed = 0.1 * std::pow(50.0, random.uniform()), reach = random.uniform(8, 16);
        walk.to(at(random.uniform(-15, 15), random.uniform(-15, 15), 12 * side, turned(0.5)), 0.5).rest(5);
        const Pose here = walk.last();
        const Vec3 beyond(1e-3 * random.uniform(-15, 15), 1e-3 * random.uniform(-15, 15), -1e-3 * reach * side);
        const Quat q = turning ? (rotationFromVector(turned(0.9)) * here.q).normalized() : here.q;
        walk.to({q, beyond}, speed, 150.0).rest(10).to(here, speed, 150.0).rest(10);
        if (k % 4 == 3) {  // round the sheet to its other side
            walk.to(at(0, 0, 12 * side), 0.5).to(at(45, 0, 12 * side), 1).to(at(45, 0, -12 * side), 1);
            walk.to(at(0, 0, -12 * side), 1).rest(20);
            side = -side;
        }
    }
    return walk.drive(worldOf(spec));
}

Drive straightStrokes(const SceneSpec& spec, std::uint64_t seed) { return strokes(spec, seed, false); }
Drive turningStrokes(const SceneSpec& spec, std::uint64_t seed) { return strokes(spec, seed, true); }

/// Along the sheet's plane against its edge, and on for a centimetre.
Drive edgeStrokes(const SceneSpec& spec, std::uint64_t seed) {
    Random random(streamSeed("hard", "", "", "edge strokes", seed));
    Walk walk(at(0, 0, 12));
    walk.to(at(45, 0, 12), 0.5);
    for (int k = 0; k < 3000; ++k) {
        const double speed = 0.1 * std::pow(50.0, random.uniform());
        const double y = random.uniform(-15, 15), z = random.uniform(-0.5, 0.5);
        const Vec3 turn(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        walk.to(at(45, y, z, turn), 0.5).rest(5);
        walk.to(at(45 - random.uniform(15, 25), y + random.uniform(-3, 3), z, turn), speed).rest(10);
        walk.to(at(45, y, z, turn), speed).rest(10);
    }
    return walk.drive(worldOf(spec));
}

/// A peg over its bore, every two seconds: down while it is pushed and tilted, held, and out again. Lengths per 20 mm
/// of depth.
Drive pegPush(const SceneSpec& spec, std::uint64_t seed, double yaw) {
    const auto dims = shape::namedDimensions(std::get<shape::Shape>(fixedPart(spec).geometry));
    double depth = 0.0;
    for (const shape::Dimension& d : dims)
        if (std::string(d.key) == "bore_depth") depth = d.value;
    const double unit = depth / 20.0;  // 1 mm of a bore of 20 mm
    const RandomPush push(streamSeed("hard", "", "", "peg", seed), unit * Vec3(1.5, 1.5, 0.3),
                          Vec3(2 * kDegree, 2 * kDegree, yaw));
    return [=, X_WO = worldOf(spec)](std::int64_t tick, const tick::TickOutput*) {
        const double t = static_cast<double>(tick) * kTickSeconds, phase = std::fmod(t, 2.0);
        const double high = 2.0 * unit, low = -depth - 3.0 * unit;
        const double share = phase < 1.0 ? phase : phase < 1.5 ? 1.0 : 2.0 * (2.0 - phase);
        const double ramp = std::min(1.0, t / 0.3);
        const Pose X = push.at(t);
        Pose pose{Quat::Identity().slerp(ramp, X.q), ramp * X.p};
        pose.p.z() += high + share * (low - high);
        return DeviceReading{X_WO * pose};
    };
}

/// The shapes that the meshes of peg and plate approximate, in their place.
SceneSpec roundSolids(SceneSpec spec) {
    for (scene::PartSpec& part : spec.parts) {
        if (part.held)
            part.geometry = shape::Shape(shape::Peg{20e-3, 24e-3, 0.5e-3});
        else
            part.geometry = shape::Shape(shape::BorePlate{26e-3, 26e-3, 23e-3, 20.2e-3, 20e-3, 0.5e-3});
    }
    return spec;
}

/// The cube that the mesh was before it was damaged.
SceneSpec cubeSolid(SceneSpec spec) {
    for (scene::PartSpec& part : spec.parts)
        if (!part.held) part.geometry = shape::Shape(shape::Box{0.02, 0.02, 0.02});
    return spec;
}

/// The pins of the mesh, each a part.
SceneSpec pinSolids(SceneSpec spec) {
    const scene::PartSpec mesh = fixedPart(spec);
    std::erase_if(spec.parts, [](const scene::PartSpec& part) { return !part.held; });
    for (int i = 0; i < 10; ++i)
        for (int k = 0; k < 10; ++k) {
            spec.parts.push_back(mesh);
            spec.parts.back().geometry = shape::Shape(shape::Box{1.5e-3, 1.5e-3, 0.01});
            spec.parts.back().X_WP = mesh.X_WP * at(-22.5 + 5 * i, -22.5 + 5 * k, -5);
        }
    return spec;
}

Drive roundPeg(const SceneSpec& spec, std::uint64_t seed) { return pegPush(spec, seed, 20 * kDegree); }
Drive pegInHand(const SceneSpec& spec, std::uint64_t seed) {
    return inHand(*simulated::findPreset("sigma7"), heldPart(spec).X_WP, roundPeg(spec, seed));
}
Drive meshPeg(const SceneSpec& spec, std::uint64_t seed) { return roundPeg(roundSolids(spec), seed); }
Drive shapedPeg(const SceneSpec& spec, std::uint64_t seed) { return pegPush(spec, seed, 1 * kDegree); }

/// Pushes the held part from its start by (0, 0, -depth), there in every direction.
Drive pushDown(const SceneSpec& spec, std::uint64_t seed, double depth_mm, const Vec3& lateral_mm, double tilt) {
    const RandomPush push(streamSeed("hard", "", "", "push", seed), 1e-3 * lateral_mm, Vec3::Constant(tilt));
    return [=, start = heldPart(spec).X_WP](std::int64_t tick, const tick::TickOutput*) {
        const double t = static_cast<double>(tick) * kTickSeconds, ramp = std::min(1.0, t / 0.3);
        const Pose X = push.at(t);
        Pose pose{(Quat::Identity().slerp(ramp, X.q) * start.q).normalized(), start.p + ramp * X.p};
        pose.p.z() -= ramp * 1e-3 * depth_mm;
        return DeviceReading{pose};
    };
}

template <int depth_mm, int lateral_mm, int tilt_deg>
Drive push(const SceneSpec& spec, std::uint64_t seed) {
    return pushDown(spec, seed, depth_mm, Vec3(lateral_mm, lateral_mm, 2), tilt_deg * kDegree);
}

Drive stay(const SceneSpec& spec, std::uint64_t) { return Walk(heldPart(spec).X_WP).drive(Pose{}); }

/// The bar is turned on and on against the posts.
Drive turnOn(const SceneSpec&, std::uint64_t) {
    Walk walk(at(0, 0, 0));
    walk.turn(Vec3::UnitZ(), 4.5 * std::numbers::pi, 6.0).turn(Vec3::UnitZ(), -9.0 * std::numbers::pi, 12.0);
    return walk.drive(Pose{});
}

/// A ball of 8 mm is pressed by 1 mm into a cube of 20 mm, straight against the nearest point of it, and drawn over its
/// faces, edges and corners.
Drive rubCube(const SceneSpec& spec, std::uint64_t seed) {
    Random random(streamSeed("hard", "", "", "rub", seed));
    std::vector<Wander> wander;
    for (int i = 0; i < 3; ++i) wander.emplace_back(random, 0.1, 0.5);
    return [=, start = heldPart(spec).X_WP.p](std::int64_t tick, const tick::TickOutput*) {
        const double t = static_cast<double>(tick) * kTickSeconds;
        const Vec3 d(wander[0].at(t), wander[1].at(t), wander[2].at(t));
        const Vec3 outside = 13e-3 / std::max(1e-3, d.cwiseAbs().maxCoeff()) * d;
        const Vec3 nearest = outside.cwiseMax(-10e-3).cwiseMin(10e-3);
        const Vec3 there = nearest + 3e-3 * (outside - nearest).normalized();
        // from the start round the cube, then towards it
        const double round = std::min(1.0, t / 0.3), in = std::clamp(t / 0.3 - 1.0, 0.0, 1.0);
        const Quat q = Quat::Identity().slerp(round, rotationBetween(start, d));
        const Vec3 from = q * start;
        return DeviceReading{{Quat::Identity(), from + in * (there - from)}};
    };
}

/// Down onto the table by `depth_mm`, there to and fro along a curve.
Drive slide(const SceneSpec& spec, std::uint64_t, double depth_mm) {
    return [=, start = heldPart(spec).X_WP](std::int64_t tick, const tick::TickOutput*) {
        const double t = static_cast<double>(tick) * kTickSeconds, ramp = std::min(1.0, t / 0.2);
        const double along = 20e-3 * std::sin(0.4 * 2 * std::numbers::pi * std::max(0.0, t - 0.2));
        return DeviceReading{{start.q, start.p + Vec3(along, 0.3 * along, -ramp * 1e-3 * (depth_mm + 2.0))}};
    };
}

/// Slides, and now and then the loop wakes late by 1, 5 and 50 ms: those ticks are missing.
Drive missTicks(const SceneSpec& spec, std::uint64_t) {
    return [inner = slide(spec, 0, 2.0), late = std::int64_t{0}](std::int64_t tick, const tick::TickOutput*) mutable {
        const std::int64_t missed = tick % 300 == 100 ? 1 : tick % 300 == 150 ? 5 : tick % 300 == 200 ? 50 : 0;
        late += missed;
        DeviceReading reading = inner(tick + late, nullptr);
        reading.periods = static_cast<std::uint32_t>(1 + missed);
        return reading;
    };
}

/// Slides with a sensor that says NaN, infinity, jumps a metre, or says the same for a while.
Drive lie(const SceneSpec& spec, std::uint64_t) {
    return [inner = slide(spec, 0, 2.0), frozen = Pose{}](std::int64_t tick, const tick::TickOutput*) mutable {
        DeviceReading reading = inner(tick, nullptr);
        const std::int64_t phase = tick % 500;
        if (phase >= 100 && phase < 100 + (tick / 500) * 7 + 1) reading.X_BD.p = Vec3(kNan, 0, 0);
        if (phase >= 200 && phase < 210) reading.X_BD.q = Quat(std::numeric_limits<double>::infinity(), 0, 0, 0);
        if (phase >= 300 && phase < 310) reading.X_BD.p += Vec3(1, -1, phase % 2 == 0 ? 1 : -1);
        if (phase < 400) frozen = reading.X_BD;
        if (phase >= 400 && phase < 460) reading.X_BD = frozen;
        return reading;
    };
}

// ---- judgements -----------------------------------------------------------------------------------------------------

/// The proxy's speed when it leaves the overlap it began with [m/s].
Judgement kick(const Run& run) {
    Judgement result;
    Pose last = heldPart(run.spec).X_WP;
    double force = 0.0;
    for (const Tick& t : run.ticks) {
        result.value = std::max(result.value, (t.proxy.p - last.p).norm() / kTickSeconds);
        force = std::max(force, t.sent.force.norm());
        last = t.proxy;
    }
    // 5 mm to the face, and a hair for the rounding of the field.
    const double allowed = run.spec.contact.stiffness * 5.1e-3;
    if (force > allowed) result.broken = fmt::format("{:.3g} N, {:.3g} allowed", force, allowed);
    Run end = run;
    end.ticks.assign(run.ticks.end() - 10, run.ticks.end());
    const double left = deepestOverlap(end);
    if (left > run.spec.contact.tolerance) result.broken = fmt::format("{:.3g} um of overlap stay", kUm * left);
    return result;
}

/// Force above the device's limit, or while there is no sample to go by [N].
Judgement forceOfLies(const Run& run) {
    Judgement result;
    for (const Tick& t : run.ticks) {
        const double force = t.sent.force.norm();
        result.value = std::max(result.value, (t.status & kInputRejected) ? force : force - run.spec.limits.max_force);
    }
    const double overlap = deepestOverlap(run);
    if (overlap > run.spec.contact.tolerance) result.broken = fmt::format("{:.3g} um of overlap", kUm * overlap);
    return result;
}

Judgement overlapOfMany(const Run& run) {
    Judgement result = overlapUm(run);
    const auto most = std::max_element(run.ticks.begin(), run.ticks.end(),
                                       [](const Tick& a, const Tick& b) { return a.contacts < b.contacts; });
    if (most->contacts < 1000) result.broken = fmt::format("only {} contacts", most->contacts);
    return result;
}

/// Pins whose tops the proxy's block touches, at the tick with the most of them: by the blocks' closed forms.
std::size_t mostTouched(const Run& run) {
    constexpr double kTouch = 2e-6;  // [m]
    const shape::Shape& block = std::get<shape::Shape>(heldPart(run.solids).geometry);
    std::size_t most = 0;
    for (const Tick& t : run.ticks) {
        const Pose X_GW = t.proxy.inverse();
        const auto touches = [&](const scene::PartSpec& pin) {
            if (pin.held) return false;
            const auto& box = std::get<shape::Box>(std::get<shape::Shape>(pin.geometry));
            double least = kTouch;
            for (const double x : {-0.5, 0.5})
                for (const double y : {-0.5, 0.5}) {
                    const Vec3 corner(x * box.width, y * box.depth, 0.5 * box.height);
                    least = std::min(least, shape::signedDistance(block, X_GW * (pin.X_WP * corner)));
                }
            return least < kTouch;
        };
        const auto count = std::count_if(run.solids.parts.begin(), run.solids.parts.end(), touches);
        most = std::max(most, static_cast<std::size_t>(count));
    }
    return most;
}

Judgement overlapOnPins(const Run& run) {
    Judgement result = overlapUm(run);
    const std::size_t touched = mostTouched(run), pins = run.solids.parts.size() - 1;
    if (pins != 100 || touched != pins) result.broken = fmt::format("{} of {} pins touched at once", touched, pins);
    return result;
}

/// Overlap per 20 mm of diameter [µm].
Judgement insertedOfTiny(const Run& run) {
    Judgement result = insertedUm(run);
    result.value *= 1000.0;
    return result;
}
Judgement insertedOfHuge(const Run& run) {
    Judgement result = insertedUm(run);
    result.value *= 20e-3 / 6.0;
    return result;
}

/// `c` with its parts laid otherwise in their frames by the seed.
Case relaid(Case c, double chord_error = 2e-6) {
    c.relaid_chord = chord_error;
    return c;
}

/// Somewhere else, with the fields of `peg_mesh`.
void coarser(SceneSpec& spec, std::uint64_t seed) {
    anywhere(spec, seed);
    spec.contact.tolerance = 10e-6;
    spec.contact.cell = 0.0;
}

constexpr const char* kOverlap = "deepest overlap";
constexpr const char* kRatio = "deepest overlap per the penalty's on the same path";
constexpr const char* kCrossed = "poses in which FCL finds the sheet in the tool less the tolerance";
constexpr double kRatioMark = 0.01;
constexpr double kPegMark = 2.0, kMeshMark = 10.0,
                 kFieldMark = 20.0;  // µm: of closed-form pegs; the scenes' tolerance_um

}  // namespace

std::span<const Case> cases() {
    static const std::vector<Case> kCases = [] {
        std::vector<Case> all{
            {"sheet_strokes", "sheet", kCrossed, "", 0, 1, 8, 8, 300, straightStrokes, crossingCount, anywhere, kGods,
             true},
            {"sheet_edge", "sheet", kCrossed, "", 0, 1, 8, 6, 150, edgeStrokes, crossingCount, anywhere, kGods, true},
            {"sheet_turning", "sheet", kCrossed, "", 0, 1, 8, 8, 300, turningStrokes, crossingCount, anywhere, kGods,
             true},
            {"peg_100um", "peg_100um", kOverlap, "um", kPegMark, 1, 20, 2.5, 60, roundPeg, insertedUm, anywhere},
            {"peg_50um", "peg_50um", kOverlap, "um", kPegMark, 1, 20, 2.5, 60, roundPeg, insertedUm, anywhere},
            {"peg_10um", "peg_10um", kOverlap, "um", kPegMark, 1, 20, 2.5, 60, roundPeg, insertedUm, anywhere},
            {"peg_100um_ratio", "peg_100um", kRatio, "", kRatioMark, 1, 5, 2, 60, pegInHand, overlapPerPenalty,
             anywhere},
            {"peg_50um_ratio", "peg_50um", kRatio, "", kRatioMark, 1, 5, 2, 60, pegInHand, overlapPerPenalty, anywhere},
            {"peg_10um_ratio", "peg_10um", kRatio, "", kRatioMark, 1, 5, 2, 60, pegInHand, overlapPerPenalty, anywhere},
            {"peg_rough", "peg_rough", kOverlap, "um", kPegMark, 1, 20, 2.5, 60, roundPeg, overlapUm, anywhere},
            {"peg_4mm", "peg_4mm", kOverlap, "um", kPegMark, 1, 20, 2.5, 60, roundPeg, insertedUm, anywhere},
            relaid({"peg_mesh", "peg_mesh", kOverlap, "um", kMeshMark, 2, 20, 2.5, 60, meshPeg, insertedUm, anywhere,
                    kGods, false, roundSolids}),
            relaid(
                {"peg_mesh_50um", "peg_50um", kOverlap, "um", kMeshMark, 2, 20, 1.6, 60, roundPeg, insertedUm, coarser},
                2.5e-6),
            relaid(
                {"peg_mesh_10um", "peg_10um", kOverlap, "um", kMeshMark, 2, 20, 1.6, 60, roundPeg, insertedUm, coarser},
                0.5e-6),
            relaid({"square_mesh", "square_peg", kOverlap, "um", kMeshMark, 2, 20, 1.6, 60, shapedPeg, insertedUm,
                    coarser}),
            {"keyed_peg", "keyed_peg", kOverlap, "um", kPegMark, 1, 20, 2.5, 60, shapedPeg, insertedUm, anywhere},
            {"square_peg", "square_peg", kOverlap, "um", kPegMark, 1, 20, 2.5, 60, shapedPeg, insertedUm, anywhere},
            {"wedge", "wedge", kOverlap, "um", kFieldMark, 1, 10, 2, 20, push<20, 4, 20>, overlapUm, anywhere},
            {"acute_corner", "acute_corner", kOverlap, "um", kFieldMark, 1, 10, 2, 20, push<20, 4, 20>, overlapUm},
            {"ball_in_cone", "ball_in_cone", kOverlap, "um", kFieldMark, 1, 10, 2, 20, push<6, 3, 20>, overlapUm},
            {"edge_on_edge", "edge_on_edge", kOverlap, "um", kFieldMark, 1, 10, 2, 20, push<8, 4, 20>, overlapUm},
            {"groove_vertex", "groove_vertex", kOverlap, "um", kFieldMark, 1, 10, 2, 20, push<18, 4, 60>, overlapUm},
            {"deep_start", "deep_start", "fastest proxy", "m/s", 1.0, 1, 1, 1, 1, stay, kick},
            {"deep_start_two_way", "deep_start_two_way", "fastest proxy", "m/s", 1.0, 1, 1, 1, 1, stay, kick},
            {"needle", "needle", kOverlap, "um", kFieldMark, 1, 10, 2, 20, push<6, 4, 20>, overlapUm},
            {"plate", "plate", kOverlap, "um", kFieldMark, 1, 10, 2, 20, push<6, 4, 30>, overlapUm},
            {"half_turn", "half_turn", kOverlap, "um", kFieldMark, 1, 1, 5, 5, turnOn, overlapUm},
            {"peg_tiny", "peg_tiny", "overlap per 20 mm of diameter", "um", kPegMark, 1, 5, 2.5, 60, roundPeg,
             insertedOfTiny},
            {"peg_huge", "peg_huge", "overlap per 20 mm of diameter", "um", kPegMark, 1, 5, 2.5, 60, roundPeg,
             insertedOfHuge},
            {"mesh_holed", "mesh_holed", kOverlap, "um", kFieldMark, 1, 5, 2, 10, rubCube, overlapUm, nullptr, kGods,
             false, cubeSolid},
            {"mesh_flipped", "mesh_flipped", kOverlap, "um", kFieldMark, 1, 5, 2, 10, rubCube, overlapUm, nullptr,
             kGods, false, cubeSolid},
            {"mesh_degenerate", "mesh_degenerate", kOverlap, "um", kFieldMark, 1, 5, 2, 10, rubCube, overlapUm, nullptr,
             kGods, false, cubeSolid},
            {"mesh_crossing", "mesh_crossing", kOverlap, "um", kFieldMark, 1, 5, 2, 10, rubCube, overlapUm, nullptr,
             kGods, false, cubeSolid},
            {"missed_ticks", "table", kOverlap, "um", kFieldMark, 1, 1, 2, 20, missTicks, overlapUm},
            {"lying_device", "table", "force above the limit or without a sample", "N", 0, 1, 1, 3, 30, lie,
             forceOfLies},
            {"thousand_contacts", "thousand_contacts", kOverlap, "um", kFieldMark, 1, 1, 0.6, 10, push<3, 2, 2>,
             overlapOfMany},
            {"hundred_patches", "hundred_patches", kOverlap, "um", kFieldMark, 1, 1, 0.6, 10, push<3, 2, 2>,
             overlapOnPins, nullptr, kGods, false, pinSolids},
        };
        for (const auto& more : {deviceCases(), truthCases()}) all.insert(all.end(), more.begin(), more.end());
        return all;
    }();
    return kCases;
}

}  // namespace passung::hard
