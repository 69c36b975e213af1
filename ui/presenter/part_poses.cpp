#include "ui/presenter/part_poses.h"

#include <algorithm>
#include <cmath>

#include "study/measures/tick_facts.h"

namespace passung::presenter {

namespace {

/// As a record has it.
Pose roundedToSingle(const Pose& X) {
    Pose rounded{Quat(X.q.coeffs().cast<float>().cast<double>()), X.p.cast<float>().cast<double>()};
    rounded.q.normalize();
    return rounded;
}

}  // namespace

PartPoses::PartPoses(const DrawnScene& scene) : shown_(scene.shown) {
    if (!scene.picking) return;
    for (const DrawnPart& part : scene.parts) {
        X_WStart_.push_back({part.X_W.q, part.X_W.p - part.shown_offset});
        X_WDrawn_.push_back(part.X_W);
        offsets_.push_back(part.shown_offset);
    }
    X_WHandStart_ = scene.picking->X_WHands;
    held_start_.assign(X_WHandStart_.size(), kNoPart);
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
        const DrawnPart& part = scene.parts[i];
        const std::size_t hand = part.other_hand ? *part.other_hand + 1 : 0;
        if ((part.held || part.other_hand) && hand < held_start_.size())
            held_start_[hand] = static_cast<std::int32_t>(i);
    }
    button_ = scene.picking->pick.button;
    no_hint_yet_ =
        measures::HintWatch(scene.picking->pick.steps, std::llround(scene.picking->hint_after / kTickSeconds));
    begin(-1);
}

void PartPoses::begin(std::int64_t tick) {
    tick_ = tick;
    done_ = 0;
    hints_ = no_hint_yet_;
    started_ = false;
    X_WP_ = X_WStart_;
    taken_at_.clear();
    for (std::size_t part = 0; part < X_WP_.size(); ++part) {
        put(part, X_WStart_[part]);
        taken_at_.push_back(X_WStart_[part].p);
    }
    hands_.assign(X_WHandStart_.size(), {});
    for (std::size_t hand = 0; hand < hands_.size(); ++hand)
        hands_[hand] = {X_WHandStart_[hand], held_start_[hand], held_start_[hand] >= 0};
    X_WG_ = X_WHandStart_;
}

void PartPoses::put(std::size_t part, const Pose& X_WP) {
    X_WP_[part] = X_WP;
    X_WDrawn_[part] = {X_WP.q, X_WP.p + offsets_[part]};
}

PartPoses::HandTick PartPoses::tickOf(const TickRecord& record) const {
    const Pose X_WG = measures::proxyPose(record);
    const bool closed = (record.input_flags >> (7 + button_) & 1u) != 0;
    return {shown_ == plan::ShownPose::Proxy ? X_WG : measures::handPose(record), X_WG, record.held, closed};
}

void PartPoses::take(std::span<const std::optional<HandTick>> hands) {
    const auto valid = [this](std::int32_t part) { return part >= 0 && static_cast<std::size_t>(part) < X_WP_.size(); };
    const std::size_t count = std::min(hands.size(), hands_.size());
    for (std::size_t hand = 0; hand < count; ++hand) {
        const std::int32_t before = hands_[hand].part;
        if (hands[hand] && valid(before) && hands[hand]->part != before)
            put(static_cast<std::size_t>(before), roundedToSingle(X_WG_[hand]));
    }
    const auto isHeld = [this](std::int32_t part) {
        return std::any_of(hands_.begin(), hands_.end(), [part](const DrawnHand& hand) { return hand.part == part; });
    };
    for (const std::optional<HandTick>& hand : hands.first(count))
        if (hand && valid(hand->part) && !isHeld(hand->part)) {
            const auto part = static_cast<std::size_t>(hand->part);
            taken_at_[part] = X_WP_[part].p;
        }
    for (std::size_t hand = count; hand-- > 0;) {  // the first of two has the last word
        if (!hands[hand]) continue;
        const HandTick& now = *hands[hand];
        if (valid(now.part)) put(static_cast<std::size_t>(now.part), now.X_WShown);
        hands_[hand] = {now.X_WShown, valid(now.part) ? now.part : kNoPart, now.closed || valid(now.part)};
        X_WG_[hand] = now.X_WG;
    }
}

/// As the session judges hints (session::TrialRule), but for cycles that were missed.
void PartPoses::lookAtSteps(const TickRecord& first, bool engaged) {
    done_ = first.steps_done;
    started_ = started_ || engaged;
    if (started_) hints_.follow(first.tick, done_);
}

void PartPoses::follow(const loop::ScreenTick& tick) {
    if (X_WStart_.empty()) return;
    const TickRecord& first = tick.record;
    if (first.tick <= tick_) begin(first.tick);
    tick_ = first.tick;
    const bool proxy = shown_ == plan::ShownPose::Proxy;
    std::array<std::optional<HandTick>, scene::kMostHands> hands;
    hands[0] = tickOf(first);
    for (std::size_t i = 0; i < tick.others.size(); ++i) {
        const loop::HeldPart& other = tick.others[i];
        hands[i + 1] = {proxy ? other.X_WG : other.X_WH, other.X_WG, other.part, other.part >= 0};
    }
    take(hands);
    lookAtSteps(first, tick.engaged);
    // It is as the tick ended, later than what the hands held as it began.
    const std::int32_t resting = tick.at_rest.part;
    if (resting >= 0 && static_cast<std::size_t>(resting) < X_WP_.size())
        put(static_cast<std::size_t>(resting), tick.at_rest.X_WP);
}

void PartPoses::follow(std::span<const TickRecord* const> records) {
    if (X_WStart_.empty()) return;
    const std::int64_t tick = records.front()->tick;
    if (tick <= tick_) begin(tick);
    tick_ = tick;
    std::array<std::optional<HandTick>, scene::kMostHands> hands;
    for (std::size_t i = 0; i < std::min(records.size(), hands.size()); ++i)
        if (records[i] != nullptr) hands[i] = tickOf(*records[i]);
    take(hands);
    lookAtSteps(*records.front(), std::all_of(records.begin(), records.end(), [](const TickRecord* record) {
        return record != nullptr && (record->status & kEngaged) != 0;
    }));
}

}  // namespace passung::presenter
