#include "study/session/hands_view.h"

#include <algorithm>
#include <array>

#include "study/measures/tick_facts.h"
#include "study/plan/scene_parts.h"

namespace passung::session {

namespace {

Vec3 vectorOf(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

Quat rotationOf(const std::array<float, 4>& q) { return Quat(q[0], q[1], q[2], q[3]).normalized(); }

std::array<float, 3> stored(const Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

std::array<float, 4> stored(const Quat& q) {
    return {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z())};
}

}  // namespace

const TickRecord* recordAt(std::span<const TickRecord> records, std::int64_t tick) {
    const auto later = std::upper_bound(records.begin(), records.end(), tick,
                                        [](std::int64_t t, const TickRecord& record) { return t < record.tick; });
    return later == records.begin() ? nullptr : &*(later - 1);
}

HandsView::HandsView(const plan::Condition& condition) : other_hands_(condition.scene.handCount() - 1) {
    if (std::holds_alternative<plan::FreePlacementTask>(condition.task.form)) return;  // its goal is in the world
    const scene::PartSpec* target = plan::partNamed(condition.scene, condition.task.target);
    if (target == nullptr || !target->held || target->hand == 0) return;
    target_hand_ = target->hand - 1;
    X_TW_start_ = target->X_WP.inverse();
}

TickRecord HandsView::of(const TickRecord& record, std::span<const std::vector<TickRecord>> others) const {
    TickRecord seen = record;
    for (std::size_t i = 0; i < other_hands_; ++i) {
        const TickRecord* other = recordAt(others[i], record.tick);
        if (other == nullptr || (other->status & kEngaged) == 0) seen.status &= ~std::uint32_t{kEngaged};
        if (other == nullptr || target_hand_ != i) continue;
        const Pose X_WT = measures::proxyPose(*other);
        const Pose back = (X_WT * X_TW_start_).inverse();
        const auto put = [&back](std::array<float, 3>& p, std::array<float, 4>& q) {
            p = stored(back * vectorOf(p));
            q = stored((back.q * rotationOf(q)).normalized());
        };
        put(seen.hand_position_m, seen.hand_quaternion);
        put(seen.proxy_position_m, seen.proxy_quaternion);
        seen.force_N = stored(back.q * vectorOf(record.force_N));
        seen.torque_Nm = stored(back.q * vectorOf(record.torque_Nm));
    }
    return seen;
}

std::vector<std::span<const TickRecord>> HandsView::recordsOfAll(
    std::span<const TickRecord> first, std::span<const std::vector<TickRecord>> others) const {
    std::vector<std::span<const TickRecord>> hands;
    if (other_hands_ == 0) return hands;
    hands.push_back(first);
    for (std::size_t i = 0; i < other_hands_; ++i) hands.emplace_back(others[i]);
    return hands;
}

std::array<const TickRecord*, scene::kMostHands> HandsView::all(const TickRecord& record,
                                                                std::span<const std::vector<TickRecord>> others) const {
    std::array<const TickRecord*, scene::kMostHands> hands{&record};
    for (std::size_t i = 0; i < other_hands_; ++i) hands[i + 1] = recordAt(others[i], record.tick);
    return hands;
}

}  // namespace passung::session
