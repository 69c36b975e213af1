#include "core/tick/pick.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "core/base/single_precision.h"
#include "core/tick/buttons.h"
#include "core/tick/tick_model.h"
#include "core/tick/tick_state.h"

namespace passung::tick {

namespace {

/// The hand that holds it, the first where two do.
std::size_t holderOf(const TickState& state, std::size_t body) noexcept {
    for (std::size_t hand = 0; hand < state.holds.size(); ++hand)
        if (state.holds[hand].body == body && !state.holds[hand].follows) return hand;
    return Hold::kNoHand;
}

/// `p_P`: where the hand would hold it, in the part.
bool canTake(const TickModel& model, const TickState& state, std::size_t hand, std::size_t body,
             const Vec3& p_P) noexcept {
    if (state.locked[body] != 0) return false;
    const std::size_t holder = holderOf(state, body);
    if (holder == Hold::kNoHand) return !(hangingTurn(model.hand(hand, body), p_P) > scene::kMostHangingTurn);
    return model.shares(hand) && model.canPick(holder) && state.holds[holder].partner == Hold::kNoHand &&
           state.hands[holder].engaged;
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
        const Vec3 p_P = state.X_WP[body].inverse() * p_WD;
        const double distance = distanceTo(model.world.bodies[body], p_P, least);
        if (!(distance < least) || !canTake(model, state, hand, body, p_P)) continue;
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
    static_cast<Ringing&>(hand) = {};
    static_cast<Stirring&>(hand) = {};
    clearPushes(hand);
    for (Wrench& wrench : hand.delay_line) wrench = {};
    for (FewOfMany<Wrench>& line : hand.push_line) line.clear();
}

/// The part is where it rests, with nothing known of its surroundings, and is held at one point.
void placePart(const HandModel& model, const std::vector<Pose>& X_WP, HandState& hand) noexcept {
    const Pose& X = X_WP[model.body];
    static_cast<Moving&>(hand) = {};
    measureBy(model, std::array{hand.p_GC}, hand);
    placeObstacles(model, X_WP, hand);
    hand.X_WT = hand.X_WG = hand.X_WR = hand.X_WH_before = hand.X_WG_begin = X;
    hand.from_hands.clear();
    hand.manifold.clear();
    hand.manifold_reach = -1.0;
    hand.cuts = 0;
    hand.tried = 0;
    hand.step.look.open = false;
    hand.step.X_WT_followed = X;
    hand.rubbing = {};
    hand.held.count = 0;
    hand.last_motion = 0.0;
    static_cast<ProxyFilter&>(hand) = {};
    static_cast<ToolMotion&>(hand) = {};
    static_cast<ClosedFormHold&>(hand) = {};
    static_cast<FilteredHold&>(hand) = {};
    if (model.hasSurfaces()) hand.surface->place(X);
}

/// Of the done steps this one is done no more; it is free to be done again once its part is let go anew.
void undoStep(const TickModel& model, TickState& state, std::size_t step) noexcept {
    AssemblyState& assembly = state.assembly;
    assembly.laid &= ~scene::stepBit(step);
    if ((assembly.done & scene::stepBit(step)) == 0) return;
    assembly.done &= ~scene::stepBit(step);
    const auto end = assembly.sequence.begin() + static_cast<std::ptrdiff_t>(assembly.count--);
    static_cast<void>(std::remove(assembly.sequence.begin(), end, static_cast<std::uint8_t>(step)));
    state.locked[model.pick.steps[step].part] = 0;
}

/// Steps with parts that were let go and lie where they belong are done. Those of parts that a hand took are not.
void settleSteps(const TickModel& model, TickState& state) noexcept {
    const std::vector<scene::AssemblyStep>& steps = model.pick.steps;
    AssemblyState& assembly = state.assembly;
    for (const Hold& hold : state.holds)
        for (std::size_t i = 0; i < steps.size(); ++i) {
            if (steps[i].part == hold.let_go) assembly.laid |= scene::stepBit(i);
            if (steps[i].part == hold.body) undoStep(model, state, i);
        }
    for (const std::size_t i : model.step_order) {
        const scene::StepSet step = scene::stepBit(i);
        const bool may_be =
            (assembly.done & step) == 0 && (assembly.laid & step) != 0 && (steps[i].after & ~assembly.done) == 0;
        if (!may_be || !scene::isAtGoal(steps[i], state.X_WP)) continue;
        assembly.done |= step;
        assembly.sequence[assembly.count++] = static_cast<std::uint8_t>(i);
        if (steps[i].locks) state.locked[steps[i].part] = 1;
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
        // A spring and damper on a mass begin where nothing is stretched.
        hand_.has_last_stretch = model.hasMass();
        regrip(model.registration.X_DH * X_DP, X_DP.inverse().p, hand_);
        if (follows) {
            hold_.follows = true;
            hold_.partner = holder;
            state_.holds[holder].partner = number_;
            hand_.X_WG = state_.X_WP[body];
            holdTogether(model, holder);
        } else {
            swapParts(hand_, state_.waiting[model_.placeOf(body)]);
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
        if (!followed) swapParts(hand_, state_.waiting[model_.placeOf(body)]);
        if (partner != Hold::kNoHand) leaveTo(partner, body, !followed);
        const HandModel& model = model_.hand(number_, kNoBody);
        forgetPast(hand_);
        regrip(model.registration.X_DH, Vec3::Zero(), hand_);
        hand_.shared = false;
        static_cast<NearPairs&>(hand_) = {};
        hand_.metric = motion::Metric{model.metric_radius};
        hand_.springs = 1;
        hand_.stiffness = 1.0;
    }

private:
    /// With the hand that holds the part already.
    void holdTogether(const HandModel& model, std::size_t holder) noexcept {
        HandState& first = state_.hands[holder];
        hand_.shared = first.shared = true;
        leaveRest(model_.hand(holder, model.body), 1.0, first);  // it hangs from its own spring no more
        measureBy(model_.hand(holder, model.body), std::array{first.p_GC, hand_.p_GC}, first);
    }

    /// What the partner held with this hand it holds alone; `takes`: it moves it from now on.
    void leaveTo(std::size_t partner, std::size_t body, bool takes) noexcept {
        HandState& other = state_.hands[partner];
        Hold& hold = state_.holds[partner];
        hold.partner = Hold::kNoHand;
        hold.follows = false;
        other.shared = false;
        leaveRest(model_.hand(partner, body), -1.0, other);
        if (takes) swapParts(other, state_.waiting[model_.placeOf(body)]);
        const HandModel& model = model_.hand(partner, body);
        measureBy(model, std::array{other.p_GC}, other);
    }

    /// What is known of the coupling's stretch, from where a part with weight hangs to the hand (1) or back (-1), goes
    /// on where the part does; else nothing is known.
    static void leaveRest(const HandModel& model, double way, Stretch& stretch) noexcept {
        if (model.hasInertia())
            stretch.last_stretch += way / model.contact.stiffness * model.weight;
        else
            stretch = {};
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
    bool changed = false;
    const std::size_t count = model.hands.size();
    for (std::size_t turn = 0; turn < count; ++turn) {
        const std::size_t i = (static_cast<std::size_t>(state.tick) + turn) % count;
        const TickFrame& frame = outputs[i].frame;
        if (!model.canPick(i) || !frame.input_usable || frame.sample_periods == 0) continue;
        Hold& hold = state.holds[i];
        const bool was_down = hold.down, knows = std::exchange(hold.seen, true);
        const bool undo_was_down = hold.undo_down;
        hold.down = isDown(readings[i], model.pick.button);
        hold.undo_down = isDown(readings[i], model.pick.undo_button);
        if (!knows || !state.hands[i].engaged) continue;
        if (hold.undo_down && !undo_was_down && state.assembly.count > 0)
            undoStep(model, state, state.assembly.sequence[state.assembly.count - 1]);
        const bool goes_down = hold.down && !was_down, goes_up = was_down && !hold.down;
        ClosingHand hand(model, state, i);
        if (hold.body != kNoBody) {
            if (!(model.pick.on_press ? goes_down : goes_up)) continue;
            hand.open();
            changed = true;
        } else if (goes_down) {
            const std::size_t nearest = nearestOf(model, state, i, frame.X_WH.p);
            if (nearest == kNoBody) continue;
            hand.close(nearest, frame.X_WH);
            changed = true;
        }
    }
    if (changed && !model.pick.steps.empty()) settleSteps(model, state);
}

}  // namespace passung::tick
