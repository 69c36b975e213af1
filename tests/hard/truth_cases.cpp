#include "tests/hard/truth_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "devices/simulated/presets.h"
#include "tests/bench/convergence_rows.h"
#include "tests/hard/figures.h"
#include "tests/hard/paths.h"
#include "tests/support/submerged.h"

namespace passung::hard {

namespace {

using scene::SceneSpec;

constexpr double kPi = std::numbers::pi;
constexpr double kMostTurn = 0.5 * kDegree;  // of a force against its truth
constexpr double kFloor = 0.05;              // of the largest force: below, errors count against that

template <class T>
const T& shapeOf(const scene::PartSpec& part) {
    return std::get<T>(std::get<shape::Shape>(part.geometry));
}

void cubicThenAnywhere(SceneSpec& spec, std::uint64_t seed) {
    if (seed % 2 == 1) spec.contact.mode = field::FieldMode::Cubic;
}

/// The whole scene turned.
void turned(SceneSpec& spec, std::uint64_t seed) {
    Random random(streamSeed("hard", "", "", "turned", seed));
    const Pose X{Quat(random.normal(), random.normal(), random.normal(), random.normal()).normalized(),
                 0.01 * Vec3(random.normal(), random.normal(), random.normal())};
    for (scene::PartSpec& part : spec.parts) part.X_WP = X * part.X_WP;
}

/// From the start to each pose by way of `clear` above it, there for three ticks.
Drive visit(const SceneSpec& spec, const std::vector<Pose>& poses, const Vec3& clear = Vec3(0, 0, 0.02)) {
    Walk walk(heldPart(spec).X_WP);
    for (const Pose& pose : poses) walk.to({pose.q, pose.p + clear}, 1.0, 60.0).to(pose, 1.0).rest(3);
    return walk.drive(Pose{});
}

/// The wrenches of all resting ticks against their truth: largest error of the magnitude [%], direction and torque
/// (per `lever`) besides; each per its own truth, or per kFloor of the run's largest where that is more.
template <class Truth>
Judgement againstTruth(const Run& run, double lever, const Truth& truth) {
    double most = 0.0, magnitude = 0.0, turn = 0.0, torque = 0.0;
    int poses = 0;
    std::vector<std::pair<Wrench, Wrench>> pairs;
    for (std::size_t i = 2; i < run.ticks.size(); ++i) {
        const Pose &X = run.ticks[i].device, &before = run.ticks[i - 1].device;
        if (!(X.p == before.p) || !(X.q.coeffs() == before.q.coeffs())) continue;
        const Wrench expected = truth(X);
        if (!(expected.force.norm() > 0.0)) continue;
        pairs.emplace_back(run.ticks[i].sent, expected);
        most = std::max(most, expected.force.norm());
        ++poses;
    }
    for (const auto& [found, expected] : pairs) {
        const double size = std::max(expected.force.norm(), kFloor * most);
        magnitude = std::max(magnitude, std::abs(found.force.norm() - expected.force.norm()) / size);
        const double cosine = found.force.normalized().dot(expected.force.normalized());
        turn = std::max(turn, std::acos(std::clamp(cosine, -1.0, 1.0)));
        torque = std::max(torque, (found.torque - expected.torque).norm() / (size * lever));
    }
    Judgement result{100.0 * magnitude};
    if (turn > kMostTurn) result.broken = fmt::format("direction {:.3g} deg", turn / kDegree);
    if (torque > 0.01) result.broken = fmt::format("torque {:.3g} %", 100.0 * torque);
    if (poses == 0) result.broken = "no pose in contact";
    return result;
}

// ---- A1 to A5: the area-weighted penalty
// -----------------------------------------------------------------------------

Drive a1Drive(const SceneSpec& spec, std::uint64_t) {
    const geometry::TriangleMesh mesh = shape::tessellate(std::get<shape::Shape>(heldPart(spec).geometry), 1e-5);
    Random random(17);
    std::vector<Pose> poses;
    for (int i = 0; i < 8; ++i) {
        const Quat q = rotationFromVector(2.0 * Vec3(random.normal(), random.normal(), random.normal()));
        double lowest = 1e300;
        for (const Vec3& v : mesh.vertices) lowest = std::min(lowest, (q * v).z());
        poses.push_back({q, Vec3(0.002, -0.001, -lowest - random.uniform(0.003, 0.006))});
    }
    return visit(spec, poses);
}

Judgement a1(const Run& run) {
    const geometry::TriangleMesh mesh = shape::tessellate(std::get<shape::Shape>(heldPart(run.spec).geometry), 2e-6);
    double reach = 0.0;
    for (const Vec3& v : mesh.vertices) reach = std::max(reach, v.norm());
    return againstTruth(run, reach, [&](const Pose& X) {
        const test::Submerged wet = test::submerged(mesh, X);
        Wrench w;
        if (!(wet.volume > 0.0)) return w;
        w.force = Vec3(0, 0, run.spec.contact.area_stiffness * wet.volume);
        w.torque = (wet.moment / wet.volume - X.p).cross(w.force);
        return w;
    });
}

Drive a2Drive(const SceneSpec& spec, std::uint64_t) {
    const double R = 0.5 * shapeOf<shape::Sphere>(heldPart(spec)).diameter;
    std::vector<Pose> poses;
    for (const double h : {0.5e-3, 1e-3, 2e-3})
        for (const double turn : {0.0, 1.0, 2.3})
            poses.push_back({rotationFromVector(turn * Vec3(1, 2, 0.5)), Vec3(0.001, 0.0003, R - h)});
    return visit(spec, poses);
}

Judgement a2(const Run& run) {
    const double R = 0.5 * shapeOf<shape::Sphere>(heldPart(run.spec)).diameter;
    return againstTruth(run, R, [&](const Pose& X) {
        const double h = std::max(0.0, R - X.p.z());
        return Wrench{{0, 0, run.spec.contact.area_stiffness * kPi * h * h * (3 * R - h) / 3}, Vec3::Zero()};
    });
}

Drive a3Drive(const SceneSpec& spec, std::uint64_t) {
    const double half = 0.5 * shapeOf<shape::Box>(heldPart(spec)).height;
    std::vector<Pose> poses;
    for (const double h : {0.2e-3, 1e-3, 1.7e-3}) poses.push_back({Quat::Identity(), Vec3(0.0013, -0.0007, half - h)});
    return visit(spec, poses);
}

Judgement a3(const Run& run) {
    const auto& box = shapeOf<shape::Box>(heldPart(run.spec));
    return againstTruth(run, 0.5 * box.width, [&](const Pose& X) {
        const double h = std::max(0.0, 0.5 * box.height - X.p.z());
        return Wrench{{0, 0, run.spec.contact.area_stiffness * box.width * box.depth * h}, Vec3::Zero()};
    });
}

Drive a4Drive(const SceneSpec& spec, std::uint64_t) {
    Random random(7);
    std::vector<Pose> poses;
    Walk walk(heldPart(spec).X_WP);
    for (int i = 0; i < 8; ++i) {
        const Vec3 d = Vec3(random.normal(), random.normal(), std::abs(random.normal())).normalized();
        walk.to({Quat::Identity(), 0.055 * d}, 1.0).to({Quat::Identity(), 0.048 * d}, 1.0).rest(3);
        walk.to({Quat::Identity(), 0.055 * d}, 1.0);
    }
    return walk.drive(Pose{});
}

Judgement a4(const Run& run) {
    const double RA = 0.5 * shapeOf<shape::Sphere>(heldPart(run.spec)).diameter;
    const double RB = 0.5 * shapeOf<shape::Sphere>(fixedPart(run.spec)).diameter;
    return againstTruth(run, RA, [&](const Pose& X) {
        const double D = X.p.norm(), a = D * D + RA * RA;
        if (D >= RA + RB) return Wrench{};
        const auto g = [&](double s) {
            return RB * a * s * s / 2 - RB * std::pow(s, 4) / 4 - a * std::pow(s, 3) / 3 + std::pow(s, 5) / 5;
        };
        const double F = run.spec.contact.area_stiffness * kPi / (D * D) * (g(RB) - g(D - RA));
        return Wrench{F * X.p.normalized(), Vec3::Zero()};
    });
}

Drive a5Drive(const SceneSpec& spec, std::uint64_t) {
    const double clearance = 0.5 * (shapeOf<shape::BorePlate>(fixedPart(spec)).bore_diameter -
                                    shapeOf<shape::Cylinder>(heldPart(spec)).diameter);
    Walk walk(heldPart(spec).X_WP);
    const Pose start = walk.last();
    for (const double angle : {0.3, 1.1, 2.9, 4.4})
        for (const double deeper : {0.1e-3, 0.2e-3}) {
            const double e = clearance + deeper;
            walk.to({start.q, start.p + Vec3(e * std::cos(angle), e * std::sin(angle), 0)}, 0.5).rest(3);
            walk.to(start, 0.5);
        }
    return walk.drive(Pose{});
}

Judgement a5(const Run& run) {
    const auto& peg = shapeOf<shape::Cylinder>(heldPart(run.spec));
    const double r = 0.5 * peg.diameter, R = 0.5 * shapeOf<shape::BorePlate>(fixedPart(run.spec)).bore_diameter;
    return againstTruth(run, r, [&](const Pose& X) {
        const double e = X.p.head<2>().norm();
        if (e <= R - r) return Wrench{};
        constexpr int n = 20000;
        double sum = 0.0;
        for (int i = 0; i < n; ++i) {
            const double angle = kPi * (i + 0.5) / n;
            const double p = std::sqrt(r * r + e * e + 2 * r * e * std::cos(angle)) - R;
            sum += std::max(0.0, p) * std::cos(angle) * kPi / n;
        }
        const Vec3 back = -Vec3(X.p.x(), X.p.y(), 0).normalized();
        return Wrench{2 * run.spec.contact.area_stiffness * peg.length * r * sum * back, Vec3::Zero()};
    });
}

// ---- A6, A7: a peg tilted in its bore -------------------------------------------------------------------------------

/// φ of  d cos φ + ℓ sin φ = D.
double tiltOf(double d, double D, double along) {
    double low = 0.0, high = std::atan2(along, d);
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (d * std::cos(middle) + along * std::sin(middle) < D ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

void shallowOrDeep(SceneSpec& spec, std::uint64_t seed) {
    for (scene::PartSpec& part : spec.parts)
        if (part.held) part.X_WP.p.z() = seed % 2 == 1 ? -5e-3 : -15e-3;
}

Drive a6Drive(const SceneSpec& spec, std::uint64_t) {
    Walk walk(heldPart(spec).X_WP);
    Pose leaning = walk.last();
    leaning.q = rotationFromVector(Vec3(0, 6 * kDegree, 0));
    walk.rest(50).to(leaning, 1.0, 0.2).rest(100);
    return walk.drive(Pose{});
}

Judgement a6(const Run& run) {
    const double d = shapeOf<shape::Peg>(heldPart(run.spec)).diameter;
    const double D = shapeOf<shape::BorePlate>(fixedPart(run.spec)).bore_diameter;
    const Pose& X = run.ticks.back().proxy;
    const Vec3 axis = X.q * Vec3::UnitZ();
    const double tilt = std::acos(std::min(1.0, axis.z()));
    const double along = (-X.p.z() + 0.5 * d * std::sin(tilt)) / std::cos(tilt);
    Judgement result{100.0 * std::abs(tilt / tiltOf(d, D, along) - 1.0)};
    if (axis.x() < 0.9 * std::sin(tilt)) result.broken = "leans to the wrong side";
    return result;
}

/// The grid of μ and ℓ/d; 5 % about the border is left out by choice of the values.
struct Wedge {
    double friction, depth_per_diameter;
};
Wedge wedgeOf(std::uint64_t seed) {
    constexpr double kFriction[] = {0.4, 0.1, 0.2, 0.6}, kDepth[] = {0.3, 0.5, 0.15, 0.8};
    return {kFriction[seed % 4], kDepth[(seed / 4) % 4]};
}

void wedged(SceneSpec& spec, std::uint64_t seed) {
    const Wedge wedge = wedgeOf(seed);
    const double D = shapeOf<shape::BorePlate>(fixedPart(spec)).bore_diameter;
    for (scene::PartSpec& part : spec.parts) {
        part.friction = part.sliding_friction = wedge.friction;
        if (!part.held) continue;
        const double d = shapeOf<shape::Peg>(part).diameter, along = wedge.depth_per_diameter * d;
        const double tilt = tiltOf(d, D, along);
        part.X_WP.q = rotationFromVector(Vec3(0, 0.98 * tilt, 0));
        // the tip between its contact with the wall and the mouth's with the side
        part.X_WP.p = Vec3(0.5 * d * std::cos(tilt) - 0.5 * D, 0, 0.5 * d * std::sin(tilt) - along * std::cos(tilt));
    }
}

constexpr double kWedgeForce = 1.0;  // [N]

/// A hand that pushes with a force along the bore and a moment about the tip that put it on the rim of the peg.
Drive a7Drive(const SceneSpec& spec, std::uint64_t) {
    const double r = 0.5 * shapeOf<shape::Peg>(heldPart(spec)).diameter;
    return [=, X = heldPart(spec).X_WP, K = spec.contact.stiffness, turn = spec.contact.rotational_stiffness](
               std::int64_t tick, const tick::TickOutput* last) {
        if (last == nullptr) return DeviceReading{X};
        const double ramp = std::min(1.0, static_cast<double>(tick) / 100.0);
        const Pose& G = last->X_WG;
        return DeviceReading{{(rotationFromVector(Vec3(0, ramp * r * kWedgeForce / turn, 0)) * G.q).normalized(),
                              G.p - Vec3(0, 0, ramp * kWedgeForce / K)}};
    };
}

/// 1 if the peg moves on where it has to jam, or the other way round.
Judgement a7(const Run& run) {
    const double friction = heldPart(run.spec).friction, d = shapeOf<shape::Peg>(heldPart(run.spec)).diameter;
    const Pose& start = heldPart(run.spec).X_WP;
    const double tilt = rotationVector(start.q).norm();
    const double along = (-start.p.z() + 0.5 * d * std::sin(tilt)) / std::cos(tilt);
    const bool jams = along / d < friction;
    const double moved = run.ticks[100].proxy.p.z() - run.ticks.back().proxy.p.z();
    return {(moved < 0.1e-3) == jams ? 0.0 : 1.0};
}

// ---- A8 to A11, A13 and noise ---------------------------------------------------------------------------------------

Drive a8Drive(const SceneSpec& spec, std::uint64_t) {
    Walk walk(at(15, 0, 15));
    walk.to(at(8, 1, 8), 0.1).rest(50).to(at(6, -1, 6), 0.1).rest(50);
    return walk.drive(fixedPart(spec).X_WP * at(10, 0, -15));  // the corner's frame
}

Judgement a8(const Run& run) {
    const Pose X_WO = fixedPart(run.spec).X_WP * at(10, 0, -15);
    const Vec3 bisector = (X_WO.q * Vec3(1, 0, 1)).normalized();
    const double R = 0.5 * shapeOf<shape::Sphere>(heldPart(run.spec)).diameter;
    Judgement result;
    double off = 0.0;
    int poses = 0;
    for (std::size_t i = 1; i < run.ticks.size(); ++i) {
        const Tick& t = run.ticks[i];
        if (t.device.p != run.ticks[i - 1].device.p || !(t.sent.force.norm() > 0.0)) continue;
        ++poses;
        const double cosine = std::min(1.0, t.sent.force.normalized().dot(bisector));
        result.value = std::max(result.value, std::acos(cosine) / kDegree);
        const Vec3 p = X_WO.inverse() * t.proxy.p;
        off = std::max(off, std::hypot(p.x() - R, p.z() - R));
    }
    if (off > 0.1 * run.spec.contact.cell) result.broken = fmt::format("proxy {:.3g} um off the corner", kUm * off);
    if (poses < 50) result.broken = "no force in the corner";
    return result;
}

Drive pressAndSlide(const SceneSpec& spec, std::uint64_t) {
    return [start = heldPart(spec).X_WP](std::int64_t tick, const tick::TickOutput*) {
        const double t = static_cast<double>(tick) * kTickSeconds, ramp = std::min(1.0, t / 0.2);
        const double along = 20e-3 * std::sin(0.4 * 2 * kPi * std::max(0.0, t - 0.2));
        const double deeper = ramp * (3.5e-3 + 0.2e-3 * std::sin(1.3 * 2 * kPi * t));
        return DeviceReading{{start.q, start.p + Vec3(along, 0.3 * along, -deeper)}};
    };
}

Judgement a9(const Run& run) {
    Judgement result{deepestOverlap(run) / run.spec.contact.cell};
    double share = 0.0;
    for (std::size_t i = 500; i < run.ticks.size(); ++i) {
        const Vec3& F = run.ticks[i].sent.force;
        share = std::max(share, F.head<2>().norm() / F.z());
    }
    if (!(share < 1e-6)) result.broken = fmt::format("tangential force {:.3g} of the normal one", share);
    return result;
}

/// The force's part above 50 Hz, per mean [%].
Judgement noise(const Run& run) {
    std::vector<double> force;
    double mean = 0.0;
    for (std::size_t i = 500; i < run.ticks.size(); ++i) {
        force.push_back(run.ticks[i].sent.force.norm());
        mean += force.back();
    }
    mean /= static_cast<double>(force.size());
    Judgement result{100.0 * rmsAbove(force, 50.0) / mean};
    if (!(mean > 0.5)) result.broken = "hardly in contact";
    return result;
}

const simulated::DeviceParams& presetOf(std::uint64_t seed) {
    const auto& presets = simulated::presets();
    return presets[seed % presets.size()];
}

void asPreset(SceneSpec& spec, std::uint64_t seed) {
    const DeviceDescription device = describe(presetOf(seed));
    spec.contact.stiffness = 0.5 * device.stable_stiffness_N_per_m;
    spec.contact.damping = device.recommended_damping_Ns_per_m;
}

Drive pressAndSlideInSteps(const SceneSpec& spec, std::uint64_t seed) {
    return [inner = pressAndSlide(spec, seed), q = presetOf(seed).quantum.value](std::int64_t tick,
                                                                                 const tick::TickOutput*) {
        DeviceReading reading = inner(tick, nullptr);
        for (int i = 0; i < 3; ++i) reading.X_BD.p[i] = q * std::round(reading.X_BD.p[i] / q);
        return reading;
    };
}

/// Noise above 50 Hz over that of a perfect wall that is given the same steps.
Judgement noiseOverFloor(const Run& run) {
    const scene::ContactSpec& c = run.spec.contact;
    const double rest = 0.5 * shapeOf<shape::Box>(heldPart(run.spec)).height;  // its origin's height on the table
    std::vector<double> found, floor;
    for (std::size_t i = 500; i < run.ticks.size(); ++i) {
        const double z = run.ticks[i].device.p.z(), before = run.ticks[i - 1].device.p.z();
        found.push_back(run.ticks[i].sent.force.norm());
        floor.push_back(std::max(0.0, c.stiffness * (rest - z) - c.damping * (z - before) / kTickSeconds));
    }
    Judgement result{rmsAbove(found, 50.0) / std::max(1e-9, rmsAbove(floor, 50.0))};
    if (!(*std::min_element(found.begin(), found.end()) > 0.0)) result.broken = "not always in contact";
    return result;
}

/// Pressed by 1 mm, then drawn by 1 µm a tick.
Drive a10Drive(const SceneSpec& spec, std::uint64_t) {
    return [start = heldPart(spec).X_WP](std::int64_t tick, const tick::TickOutput*) {
        const double down = 5e-6 * static_cast<double>(std::min<std::int64_t>(tick, 200));
        const double along = 1e-6 * static_cast<double>(std::max<std::int64_t>(0, tick - 200));
        return DeviceReading{start * Pose{Quat::Identity(), Vec3(0.8 * along, 0.6 * along, -down)}};
    };
}

Judgement a10(const Run& run) {
    const Pose start = heldPart(run.spec).X_WP;
    const Vec3 n = start.q * Vec3::UnitZ(), along = start.q * Vec3(0.8, 0.6, 0.0);
    const Vec3 there = run.ticks[200].proxy.p;
    double at_rest = 0.0, error = 0.0;
    for (std::size_t i = 201; i < run.ticks.size(); ++i) {
        const Vec3& F = run.ticks[i].sent.force;
        const double share = (F - F.dot(n) * n).norm() / F.dot(n);
        if ((run.ticks[i].proxy.p - there).dot(along) < 1e-9)
            at_rest = std::max(at_rest, share);
        else if (i > 1200)
            error = std::max(error, std::abs(share / heldPart(run.spec).sliding_friction - 1.0));
    }
    error = std::max(error, std::abs(at_rest / heldPart(run.spec).friction - 1.0));
    return {100.0 * error};
}

Drive a10TurnDrive(const SceneSpec& spec, std::uint64_t) {
    return [start = heldPart(spec).X_WP](std::int64_t tick, const tick::TickOutput*) {
        const double down = 5e-6 * static_cast<double>(std::min<std::int64_t>(tick, 200));
        const double turn = 1e-5 * static_cast<double>(std::max<std::int64_t>(0, tick - 200));
        return DeviceReading{start * Pose{rotationFromVector(Vec3(0, 0, turn)), Vec3(0, 0, -down)}};
    };
}

Judgement a10Turn(const Run& run) {
    const Vec3 n = heldPart(run.spec).X_WP.q * Vec3::UnitZ();
    const Wrench& w = run.ticks.back().sent;
    const double R = 0.5 * shapeOf<shape::Cylinder>(heldPart(run.spec)).diameter;
    const double expected = 2.0 / 3.0 * heldPart(run.spec).sliding_friction * w.force.dot(n) * R;
    return {100.0 * std::abs(-w.torque.dot(n) / expected - 1.0)};
}

/// Strokes at 0.1 to 0.5 m/s through the plate, 10 mm beyond and back.
Drive a11Drive(const SceneSpec& spec, std::uint64_t seed) {
    Random random(streamSeed("hard", "", "", "a11", seed));
    Walk walk(at(0, 0, 8));
    for (int k = 0; k < 2000; ++k) {
        const double speed = random.uniform(0.1, 0.5);
        walk.to(at(random.uniform(-9, 9), random.uniform(-9, 9), 8), 0.5);
        const Pose here = walk.last();
        walk.to(at(1e3 * here.p.x() + random.uniform(-3, 3), 1e3 * here.p.y(), -8), speed).rest(5).to(here, speed);
    }
    return walk.drive(fixedPart(spec).X_WP);
}

Case onSurfaces(Case c) {
    c.geometry = scene::Geometry::Surface;
    return c;
}

/// Down by 1 mm and up again; on the way `aside` [mm] along the plane, and back in the air.
Drive cycle(const SceneSpec& spec, double aside) {
    const Pose start = heldPart(spec).X_WP;
    Walk walk(start);
    const auto from = [&](double x, double z) { return Pose{start.q, start.p + 1e-3 * Vec3(x, 0, z)}; };
    walk.to(from(0, -2), 0.01).rest(20).to(from(aside, -2), 0.02).to(from(aside, 0), 0.01).to(from(0, 0), 0.02);
    return walk.drive(Pose{});
}

/// So slow that the kinetic energy that a tool's mass brings to the contact, and implicit Euler takes, is none.
Drive a13SlowDrive(const SceneSpec& spec, std::uint64_t) {
    const Pose start = heldPart(spec).X_WP, below{start.q, start.p - Vec3(0, 0, 2e-3)};
    return Walk(start).to(below, 0.001).rest(20).to(start, 0.001).drive(Pose{});
}

Drive a13Drive(const SceneSpec& spec, std::uint64_t) { return cycle(spec, 0.0); }
Drive a13SlideDrive(const SceneSpec& spec, std::uint64_t) { return cycle(spec, 5.0); }

void quasiStatic(SceneSpec& spec, std::uint64_t) { spec.contact.coupling = scene::PenaltyCoupling::QuasiStatic; }

Judgement a13(const Run& run) {
    double work = 0.0, stored = 0.0, most = 0.0;
    for (std::size_t i = 1; i < run.ticks.size(); ++i) {
        const Tick &a = run.ticks[i - 1], &b = run.ticks[i];
        work += 0.5 * (a.sent.force + b.sent.force).dot(b.device.p - a.device.p);
        work += 0.5 * (a.sent.torque + b.sent.torque).dot(rotationVector(b.device.q * a.device.q.conjugate()));
        stored = std::max(stored, -work);
        most = std::max(most, b.sent.force.norm());
    }
    Judgement result{100.0 * std::abs(work) / stored};
    if (!(most > 0.1)) result.broken = "no contact";
    return result;
}

/// A12: by how much the worst order of convergence falls short of what convergence_rows.h derives.
Result<Measured> a12() {
    bench::Extent all;
    all.wanted = [](const std::string&, const std::string&) { return true; };
    const auto rows = bench::convergenceRows(all);
    if (!rows) return rows.errors();
    Measured result;
    result.judgement.value = -std::numeric_limits<double>::infinity();
    for (const bench::Row& row : *rows) {
        const bool smooth = row.method == bench::kCellOnSmooth || row.method == bench::kSpacingOnSmooth;
        const double derived = smooth ? 2.0 : row.method == bench::kCellAtEdges ? 1.0 : 4.0 / 3.0;
        result.judgement.value = std::max(result.judgement.value, derived - row.order);
    }
    return result;
}

}  // namespace

std::vector<Case> truthCases() {
    constexpr unsigned kPenalty = 0b001, kAll = 0b111;
    constexpr const char *kForce = "error of the force, all poses", *kNoise = "force above 50 Hz";
    return {
        {"a1_submerged_body", "a1", kForce, "%", 1, 2, 2, 0.6, 0.6, a1Drive, a1, cubicThenAnywhere, kPenalty},
        {"a2_sphere_plane", "a2", kForce, "%", 1, 2, 2, 0.6, 0.6, a2Drive, a2, cubicThenAnywhere, kPenalty},
        {"a3_box_plane", "a3", kForce, "%", 1, 2, 2, 0.3, 0.3, a3Drive, a3, cubicThenAnywhere, kPenalty},
        {"a4_sphere_sphere", "a4", kForce, "%", 1, 2, 2, 1.2, 1.2, a4Drive, a4, cubicThenAnywhere, kPenalty},
        {"a5_peg_offset", "a5", kForce, "%", 1, 2, 2, 0.2, 0.2, a5Drive, a5, cubicThenAnywhere, kPenalty},
        {"a6_peg_tilt", "a6", "tilt at two contacts", "%", 2, 3, 3, 0.8, 0.8, a6Drive, a6, shallowOrDeep},
        {"a7_wedging", "a7", "wrong decisions, friction by depth", "", 0, 8, 16, 0.15, 0.4, a7Drive, a7, wedged, kGods,
         true},
        onSurfaces({"a7_wedging_surface", "a7", "wrong decisions, friction by depth", "", 0, 8, 16, 0.15, 0.4, a7Drive,
                    a7, wedged, kGods, true}),
        {"a8_corner", "a8", "force off the bisector", "deg", 0.5, 6, 20, 0.4, 0.4, a8Drive, a8, turned, kGods, false,
         nullptr, nullptr, 2e-6},
        {"a9_plane", "table", "overlap per cell", "", 0.05, 1, 1, 3, 3, pressAndSlide, a9},
        {"a9_plane_two_way", "table_two_way", "overlap per cell", "", 0.05, 1, 1, 3, 3, pressAndSlide, a9},
        {"a10_cone", "a10_block", "friction against its coefficient", "%", 1, 2, 5, 2.2, 2.2, a10Drive, a10, turned},
        {"a10_cone_two_way", "a10_two_way", "friction against its coefficient", "%", 1, 1, 5, 1.5, 2.2, a10Drive, a10,
         turned},
        onSurfaces({"a10_cone_surface", "a10_block", "friction against its coefficient", "%", 1, 2, 5, 2.2, 2.2,
                    a10Drive, a10, turned}),
        onSurfaces({"a10_torsion_surface", "a10_disc", "torque against 2/3 mu F R", "%", 5, 2, 5, 0.8, 0.8,
                    a10TurnDrive, a10Turn, turned}),
        {"a10_torsion", "a10_disc", "torque against 2/3 mu F R", "%", 5, 2, 5, 0.8, 0.8, a10TurnDrive, a10Turn, turned},
        {"a11_thin_plate", "a11", "poses in which FCL finds the plate in the ball", "", 0, 1, 10, 8, 500, a11Drive,
         crossingCount},
        // Of fields and points alone, whatever method they serve: once.
        {"a12_convergence", "", "order of convergence short of the derived one", "", 0.25, 1, 1, 0, 0, nullptr, nullptr,
         nullptr, kPenalty, false, nullptr, a12},
        {"a13_cycle", "ball_on_table", "work of a closed cycle per stored energy", "%", 0.1, 1, 1, 1.2, 1.2, a13Drive,
         a13, nullptr, kAll},
        {"a13_cycle_aside", "ball_on_table", "work of a closed cycle per stored energy", "%", 0.1, 1, 1, 1.2, 1.2,
         a13SlideDrive, a13},
        {"a13_cycle_coupled", "coupled_cycle", "work of a closed cycle per stored energy, virtual and quasi-static",
         "%", 0.1, 2, 2, 4.2, 4.2, a13SlowDrive, a13, quasiStatic, kPenalty},
        {"noise_smooth", "table", kNoise, "%", 0.5, 1, 1, 3, 10, pressAndSlide, noise},
        {"noise_two_way", "table_two_way", kNoise, "%", 0.5, 1, 1, 3, 10, pressAndSlide, noise},
        {"noise_in_steps", "table", "force above 50 Hz over a perfect wall's", "", 1.2, 7, 7, 3, 10,
         pressAndSlideInSteps, noiseOverFloor, asPreset},
    };
}

}  // namespace passung::hard
