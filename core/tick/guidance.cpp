#include "core/tick/guidance.h"

#include <algorithm>
#include <cmath>

namespace passung::tick {

namespace {

/// `v`, no longer than `most`.
Vec3 within(const Vec3& v, double most) noexcept {
    const double length = v.norm();
    return length > most ? Vec3(most / length * v) : v;
}

}  // namespace

void guideHand(const HandModel& model, const HandSample& hand, Guiding& guide, GuidanceShare& added) noexcept {
    added.of_guidance = Wrench{};
    if (!hand.input_usable) return;
    const scene::Guidance& g = model.effects.guidance;
    const double length = model.way.length();
    const double here = model.way.nearest(hand.X_WH, guide.gone - g.lead, guide.gone + g.lead);
    const double on = std::min(here + g.lead, std::max(guide.gone, here) + g.speed * kTickSeconds);
    guide.gone = std::min(std::max(guide.gone, on), length);
    const Pose X_WS = model.way.at(guide.gone);
    const Vec3 turn = rotationVector(X_WS.q * hand.X_WH.q.conjugate());
    added.of_guidance = {g.share * g.stiffness * within(X_WS.p - hand.X_WH.p, g.lead),
                         g.share * g.rotational_stiffness * within(turn, g.lead / model.metric_radius)};
    added.guided = length > 0.0 ? guide.gone / length : 1.0;
}

}  // namespace passung::tick
