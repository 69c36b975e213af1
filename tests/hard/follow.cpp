#include "tests/hard/follow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/hard/figures.h"

namespace passung::hard {

namespace {

constexpr std::size_t kStride = 4;       // ticks from look to look
constexpr int kLooks = 5;                // in a row
constexpr int kWay = 20;                 // poses on a way
constexpr double kSpacing = 1.0 / 15.0;  // of samples on faces, per reach
constexpr double kChord = 1e-3;

/// Lengths of a scene.
struct Scale {
    double reach, clear, lag;
};

Scale scaleOf(const Run& run) {
    double reach = 0.0;
    for (const Vec3& v : shape::tessellate(std::get<shape::Shape>(heldPart(run.solids).geometry), kChord).vertices)
        reach = std::max(reach, v.norm());
    double clear = reach / 200.0;
    for (const scene::PartSpec& part : run.solids.parts)
        if (std::holds_alternative<shape::Sheet>(std::get<shape::Shape>(part.geometry)))
            clear = reach / 200.0 + run.spec.contact.cell;
    return {reach, clear, reach / 1000.0};
}

/// True if on the straight way from `proxy` to the device, which is free by `clear`, nothing is in between.
bool wayIsFree(DenseDistance& distance, const Tick& t, double clear, double slack) {
    for (int i = kWay - 1; i > 0; --i) {
        const double share = static_cast<double>(i) / kWay, wanted = share * clear - slack;
        const Pose X{t.proxy.q.slerp(share, t.device.q), t.proxy.p + share * (t.device.p - t.proxy.p)};
        if (distance.least(X, wanted) < wanted) return false;
    }
    return true;
}

}  // namespace

std::string followFault(const Run& run) {
    const Scale scale = scaleOf(run);
    const double spacing = kSpacing * scale.reach;
    DenseDistance device = denseDistance(run, spacing), proxy = denseDistance(run, spacing);
    DenseDistance way = denseDistance(run, spacing);
    int without_force = 0, in_the_air = 0, not_back = 0;
    bool touched = false;
    const bool has_mass = run.spec.contact.coupling == scene::PenaltyCoupling::Virtual;
    for (std::size_t i = 0; i < run.ticks.size(); i += kStride) {
        const Tick& t = run.ticks[i];
        if (t.status & kInputRejected) continue;
        const double depth = device.least(t.device, scale.clear);
        const bool pressed = depth<-scale.clear, sent = t.sent.force.norm()> 0.0 || t.sent.torque.norm() > 0.0;
        touched = touched || (depth < 0.0 && sent);
        without_force = pressed && !sent ? without_force + 1 : 0;
        const double lag =
            (t.proxy.p - t.device.p).norm() + scale.reach * rotationVector(t.proxy.q * t.device.q.conjugate()).norm();
        const bool away = lag >= scale.lag && !has_mass;
        in_the_air = away && proxy.least(t.proxy, scale.clear) >= scale.clear ? in_the_air + 1 : 0;
        const bool free = away && depth >= scale.clear;
        not_back = free && wayIsFree(way, t, scale.clear, run.spec.contact.tolerance) ? not_back + 1 : 0;
        const auto fault = [&](const char* what, double length) {
            return fmt::format("{} at tick {} ({:.3g} um)", what, i, kUm * length);
        };
        if (without_force == kLooks) return fault("no force in overlap", -depth);
        if (in_the_air == kLooks) return fault("the proxy stays away and touches nothing", lag);
        if (not_back == kLooks) return fault("the proxy does not come to the free device", lag);
    }
    return touched ? "" : "the device's path touches nothing, or no force is sent where it does";
}

}  // namespace passung::hard
