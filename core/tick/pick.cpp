#include "core/tick/pick.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/single_precision.h"
#include "core/tick/tick_model.h"
#include "core/tick/tick_state.h"

namespace passung::tick {

namespace {

std::size_t waitingPlaceOf(const TickModel& model, std::size_t body) noexcept {
    const auto at = std::lower_bound(model.pickable.begin(), model.pickable.end(), body);
    return static_cast<std::size_t>(at - model.pickable.begin());
}

/// The hand that holds it, the first where two do.
std::size_t holderOf(const TickState& state, std::size_t body) noexcept {
    for (std::size_t hand = 0; hand < state.holds.size(); ++hand)
        if (state.holds[hand].body == body && !state.holds[hand].follows) return hand;
    return Hold::kNoHand;
}

bool canTake(const TickModel& model, const TickState& state, std::size_t hand, std::size_t body) noexcept {
    if (state.locked[body] != 0) return false;
    const std::size_t holder = holderOf(state, body);
    if (holder == Hold::kNoHand) return true;
    return model.shares(hand) && model.canPick(holder) && state.holds[holder].partner == Hold::kNoHand;
}

/// Distance of a point of the part's frame from the part, if it is less than `most`; else that [m].
double distanceTo(const Body& body, const Vec3& p, double most) noexcept {
    const Vec3 beyond = (body.box.low - p).cwiseMax(p - body.box.high).cwiseMax(0.0);
    if (!(beyond.norm() < most)) return most;
    const double distance = body.faces->closest(p, most).distance;
    return beyond.isZero(0.0) && body.faces->inside(p) ? 0.0 : distance;
}

/// What a hand at this point closes on; kNoBody: nothing.
std::size_t nearestOf(const TickModel& model, const TickState& state, std::size_t hand, const Vec3& p_WD) noexcept {
    std::size_t nearest = kNoBody;
    double least = std::nextafter(model.pick.reach, std::numeric_limits<double>::infinity());
    for (const std::size_t body : model.pickable) {
        if (!canTake(model, state, hand, body)) continue;
        const double distance = distanceTo(model.world.bodies[body], state.X_WP[body].inverse() * p_WD, least);
        if (!(distance < least)) continue;
        least = distance;
        nearest = body;
    }
    return nearest;
}

Pose roundedToSingle(const Pose& X) noexcept {
    Pose there{Quat(roundedToFloat(X.q.w()), roundedToFloat(X.q.x()), roundedToFloat(X.q.y()), roundedToFloat(X.q.z())),
               roundedToFloat(X.p)};
    there.q.normalize();
    return there;
}

/// What the hand felt and did with another part, or none, tells nothing of what it does now.
void forgetPast(HandState& hand) noexcept {
    static_cast<Stretch&>(hand) = {};
    static_cast<HandVelocity&>(hand) = {};
    hand.has_last = hand.in_contact = false;
    clearPushes(hand);
    for (FewOfMany<Wrench>& line : hand.push_line) {
        const Wrench of_none = std::as_const(line).back();
        line.clear();
        line.back() = of_none;
    }
}

/// Its motions are measured so from now on.
void measureBy(const HandModel& model, const motion::Metric& metric, int springs, HandState& hand) noexcept {
    hand.metric = metric;
    hand.springs = springs;
    if (model.hasClosedForm()) hand.solver.measureBy(metric);
    if (model.hasSurfaces()) hand.surface->measureBy(metric);
    if (model.hasFieldProxy()) hand.step.look.open = false;
}

/// Shares of the weight as a beam on two supports has them.
double shareOf(const HandModel& model, const Vec3& own, const Vec3& other) noexcept {
    const Vec3 between = own - other;
    const double square = between.squaredNorm();
    return square > 0.0 ? std::clamp((model.centre - other).dot(between) / square, 0.0, 1.0) : 0.5;
}

/// The part is elsewhere in the handle, which has not moved (navigation.h).
void regrip(const Pose& X_DG, const Vec3& p_GC, HandState& hand) noexcept {
    const Pose change = hand.X_DG.inverse() * X_DG;
    hand.X_DG = X_DG;
    hand.X_DG.q.normalize();
    hand.p_GC = p_GC;
    hand.sample.X_WH = hand.sample.X_WH * change;
    hand.clutch.noted = false;
    hand.touching = false;
}

/// The part is where it rests, with nothing known of its surroundings, and is held at one point.
void placePart(const HandModel& model, const std::vector<Pose>& X_WP, HandState& hand) noexcept {
    const Pose& X = X_WP[model.body];
    measureBy(model, {model.metric_radius, hand.p_GC}, 1, hand);
    hand.X_WT = hand.X_WG = hand.X_WR = hand.X_WH_before = hand.X_WG_begin = X;
    hand.from_hands.clear();
    hand.carried_count = 0;
    for (const std::uint32_t i : model.moving) hand.X_WO_known[i] = hand.X_WO[i] = X_WP[model.obstacles[i].body];
    const auto place = [&](geometry::NearList& near) {
        for (const std::uint32_t i : model.moving) {
            near.carry(i, hand.X_WO[i]);
            near.rest(i);
        }
    };
    hand.manifold.clear();
    hand.manifold_reach = -1.0;
    hand.cuts = 0;
    hand.tried = 0;
    hand.step.look.open = false;
    hand.step.X_WT_followed = X;
    static_cast<ProxyMotion&>(hand) = {};
    static_cast<ProxyFilter&>(hand) = {};
    static_cast<ToolMotion&>(hand) = {};
    static_cast<ClosedFormHold&>(hand) = {};
    static_cast<FilteredHold&>(hand) = {};
    if (model.hasClosedForm()) {
        for (const std::uint32_t i : model.moving) {
            hand.solver.place(i, hand.X_WO[i]);
            hand.at_hand[i].place(hand.X_WO[i]);
        }
        place(hand.solver.near());
        place(hand.near_hand);
    } else if (model.hasSurfaces()) {
        for (const std::uint32_t i : model.moving) {
            hand.surface->leaveBody(surfaceBodyOf(model, i));
            hand.surface->moveBody(surfaceBodyOf(model, i), hand.X_WO[i]);
        }
        hand.surface->place(X);
    } else {
        place(hand.around_proxy.near);
        place(hand.around_hand.near);
    }
}

/// A hand at the end of a tick.
class ClosingHand {
public:
    ClosingHand(const TickModel& model, TickState& state, std::size_t hand) noexcept
        : model_(model), state_(state), number_(hand), hold_(state.holds[hand]), hand_(state.hands[hand]) {}

    /// Takes `body`, with the hand's frame at `X_WD`.
    void close(std::size_t body, const Pose& X_WD) noexcept {
        const std::size_t holder = holderOf(state_, body);
        const bool follows = holder != Hold::kNoHand;
        const HandModel& model = model_.hand(number_, body, follows);
        const Pose X_DP = X_WD.inverse() * state_.X_WP[body];
        hold_.body = body;
        forgetPast(hand_);
        regrip(model.registration.X_DH * X_DP, X_DP.inverse().p, hand_);
        if (follows) {
            hold_.follows = true;
            hold_.partner = holder;
            state_.holds[holder].partner = number_;
            hand_.X_WG = state_.X_WP[body];
            holdTogether(model, holder);
        } else {
            swapParts(hand_, state_.waiting[placeOf(body)]);
            placePart(model, state_.X_WP, hand_);
        }
    }

    void open() noexcept {
        const std::size_t body = std::exchange(hold_.body, kNoBody);
        const std::size_t partner = std::exchange(hold_.partner, Hold::kNoHand);
        const bool followed = std::exchange(hold_.follows, false);
        if (partner == Hold::kNoHand) {
            state_.X_WP[body] = roundedToSingle(hand_.X_WG);
            if (model_.pick.locks) state_.locked[body] = 1;
            hold_.let_go = body;
        }
        if (!followed) swapParts(hand_, state_.waiting[placeOf(body)]);
        if (partner != Hold::kNoHand) leaveTo(partner, body, !followed);
        const HandModel& model = model_.hand(number_, kNoBody);
        forgetPast(hand_);
        regrip(model.registration.X_DH, Vec3::Zero(), hand_);
        hand_.shared = false;
        hand_.share = 1.0;
        hand_.metric = motion::Metric{model.metric_radius};
    }

private:
    std::size_t placeOf(std::size_t body) const noexcept { return waitingPlaceOf(model_, body); }

    /// With the hand that holds the part already.
    void holdTogether(const HandModel& model, std::size_t holder) noexcept {
        HandState& first = state_.hands[holder];
        hand_.shared = first.shared = true;
        hand_.share = shareOf(model, hand_.p_GC, first.p_GC);
        first.share = 1.0 - hand_.share;
        measureBy(model_.hand(holder, model.body),
                  motion::Metric::betweenHands(model.metric_radius, first.p_GC, hand_.p_GC), 2, first);
    }

    /// What the partner held with this hand it holds alone; `takes`: it moves it from now on.
    void leaveTo(std::size_t partner, std::size_t body, bool takes) noexcept {
        HandState& other = state_.hands[partner];
        Hold& hold = state_.holds[partner];
        hold.partner = Hold::kNoHand;
        hold.follows = false;
        other.shared = false;
        other.share = 1.0;
        if (takes) swapParts(other, state_.waiting[placeOf(body)]);
        const HandModel& model = model_.hand(partner, body);
        measureBy(model, {model.metric_radius, other.p_GC}, 1, other);
    }

    const TickModel& model_;
    TickState& state_;
    std::size_t number_;
    Hold& hold_;
    HandState& hand_;
};

}  // namespace

void pickAndLetGo(const TickModel& model, TickState& state, std::span<const DeviceReading> readings,
                  std::span<const TickOutput> outputs) noexcept {
    for (Hold& hold : state.holds) hold.let_go = kNoBody;
    const std::size_t count = model.hands.size();
    for (std::size_t turn = 0; turn < count; ++turn) {
        const std::size_t i = (static_cast<std::size_t>(state.tick) + turn) % count;
        const TickFrame& frame = outputs[i].frame;
        if (!model.canPick(i) || !frame.input_usable || !state.hands[i].engaged) continue;
        Hold& hold = state.holds[i];
        const bool was_down = std::exchange(hold.down, (readings[i].buttons >> (model.pick.button - 1) & 1u) != 0);
        const bool goes_down = hold.down && !was_down, goes_up = was_down && !hold.down;
        ClosingHand hand(model, state, i);
        if (hold.body != kNoBody) {
            if (model.pick.on_press ? goes_down : goes_up) hand.open();
        } else if (goes_down) {
            const std::size_t nearest = nearestOf(model, state, i, frame.X_WH.p);
            if (nearest != kNoBody) hand.close(nearest, frame.X_WH);
        }
    }
}

}  // namespace passung::tick
