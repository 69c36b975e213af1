#include "core/geometry/near_list.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace passung::geometry {

namespace {

double distanceFromBox(const Vec3& p, const Vec3& half) noexcept { return (p.cwiseAbs() - half).cwiseMax(0.0).norm(); }

constexpr auto kLater = [](const auto& a, const auto& b) { return a.key > b.key; };

}  // namespace

NearList::Ball NearList::ballOf(const Bounds& box) {
    const Vec3 half = 0.5 * box.size();
    return {0.5 * (box.low + box.high), half, half.norm()};
}

NearList::NearList(const Bounds& held, std::span<const NearPart> parts) : held_(ballOf(held)) {
    farthest_ = held.low.cwiseAbs().cwiseMax(held.high.cwiseAbs()).norm();
    std::size_t resting = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        all_.push_back(static_cast<std::uint32_t>(i));
        resting += parts[i].moves ? 0 : 1;
    }
    if (resting <= kAll) return;
    for (const NearPart& part : parts) {
        parts_.push_back({ballOf(part.box), Quat::Identity()});
        centres_.push_back(parts_.back().ball.centre);
        place(static_cast<std::uint32_t>(parts_.size() - 1), part.X_WP);
        moves_.push_back(part.moves ? 1 : 0);
    }
    near_ = woken_ = merged_ = all_;
    sleeping_.resize(parts.size());
    // Nothing is known of them yet: all that rest are due.
    near_count_ = 0;
    for (const std::uint32_t i : all_) {
        if (moves_[i] != 0)
            near_[near_count_++] = i;
        else
            sleeping_[asleep_++] = {-std::numeric_limits<double>::infinity(), i};
    }
}

void NearList::place(std::uint32_t i, const Pose& X_WP) noexcept {
    parts_[i].q_PW = X_WP.q.conjugate();
    parts_[i].ball.centre = X_WP * centres_[i];
}

void NearList::carry(std::uint32_t i, const Pose& X_WP) noexcept {
    if (hasAll()) return;
    place(i, X_WP);
    if (moves_[i] != 0) return;
    moves_[i] = 1;
    const auto begin = sleeping_.begin(), end = begin + static_cast<std::ptrdiff_t>(asleep_);
    const auto at = std::find_if(begin, end, [i](const Sleep& sleep) { return sleep.part == i; });
    if (at == end) return;  // it is near
    *at = sleeping_[--asleep_];
    std::make_heap(begin, begin + static_cast<std::ptrdiff_t>(asleep_), kLater);
    const auto near = near_.begin(), near_end = near + static_cast<std::ptrdiff_t>(near_count_);
    const auto place = std::upper_bound(near, near_end, i);
    std::move_backward(place, near_end, near_end + 1);
    *place = i;
    ++near_count_;
}

double NearList::gap(std::uint32_t i, const Pose& X_WG) const noexcept {
    const Placed& part = parts_[i];
    const Vec3 apart = part.ball.centre - X_WG * held_.centre;
    return std::max(distanceFromBox(part.q_PW * apart, part.ball.half) - held_.radius,
                    distanceFromBox(X_WG.q.conjugate() * apart, held_.half) - part.ball.radius);
}

/// S, and after a jump the keys.
void NearList::travel(const Pose& X_WG) noexcept {
    double way = 0.0;
    if (placed_) {
        const auto &now = X_WG.q.coeffs(), &last = X_last_.q.coeffs();
        const double chord = 2.0 * std::sqrt(std::min((now - last).squaredNorm(), (now + last).squaredNorm()));
        way = (X_WG.p - X_last_.p).norm() + chord * farthest_;
        if (way > 0.0) travelled_ += way + travelled_ * std::numeric_limits<double>::epsilon();
        if (!(way > 0.0 || way == 0.0)) travelled_ = way;
    }
    const bool jumps = !placed_ || way > kJump;
    X_last_ = X_WG;
    placed_ = true;
    if (!jumps) return;
    for (std::size_t i = 0; i < asleep_; ++i) sleeping_[i].key = travelled_ + lookAt(sleeping_[i].part, X_WG);
    std::make_heap(sleeping_.begin(), sleeping_.begin() + static_cast<std::ptrdiff_t>(asleep_), kLater);
}

void NearList::putToSleep(std::uint32_t part, double gap) noexcept {
    sleeping_[asleep_++] = {travelled_ + gap, part};
    std::push_heap(sleeping_.begin(), sleeping_.begin() + static_cast<std::ptrdiff_t>(asleep_), kLater);
}

std::span<const std::uint32_t> NearList::within(const Pose& X_WG, double reach) noexcept {
    if (hasAll() || search_ == Search::All) return all_;
    travel(X_WG);
    const double due =
        search_ == Search::Keys ? travelled_ + reach + kRounding : std::numeric_limits<double>::infinity();
    // Those that were asleep and may be near now, before others fall asleep.
    std::size_t woken = 0;
    while (asleep_ > 0 && !(sleeping_.front().key > due)) {
        std::pop_heap(sleeping_.begin(), sleeping_.begin() + static_cast<std::ptrdiff_t>(asleep_), kLater);
        woken_[woken++] = sleeping_[--asleep_].part;
    }
    std::size_t near = 0;
    for (std::size_t i = 0; i < near_count_; ++i) {
        const std::uint32_t part = near_[i];
        const double gap = moves_[part] != 0 ? reach : lookAt(part, X_WG);
        if (gap > reach)
            putToSleep(part, gap);
        else
            near_[near++] = part;
    }
    near_count_ = near;
    if (woken == 0) return {near_.data(), near_count_};
    std::size_t came = 0;
    for (std::size_t i = 0; i < woken; ++i) {
        const double gap = lookAt(woken_[i], X_WG);
        if (gap > reach)
            putToSleep(woken_[i], gap);
        else
            woken_[came++] = woken_[i];
    }
    if (came == 0) return {near_.data(), near_count_};
    const auto end = woken_.begin() + static_cast<std::ptrdiff_t>(came);
    std::sort(woken_.begin(), end);
    std::merge(near_.begin(), near_.begin() + static_cast<std::ptrdiff_t>(near_count_), woken_.begin(), end,
               merged_.begin());
    near_count_ += came;
    std::swap(near_, merged_);
    return {near_.data(), near_count_};
}

}  // namespace passung::geometry
