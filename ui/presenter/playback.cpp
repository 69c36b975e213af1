#include "ui/presenter/playback.h"

#include <algorithm>

#include "study/session/hands_view.h"

namespace passung::presenter {

namespace {

constexpr std::size_t kEvery = 1024;  // records: poses of all parts are kept so often

}  // namespace

Playback::Playback(std::vector<TickRecord> records, std::shared_ptr<const DrawnScene> scene,
                   std::vector<std::vector<TickRecord>> others)
    : records_(std::move(records)), others_(std::move(others)), scene_(std::move(scene)) {
    // A trial begins when all hands are engaged.
    for (TickRecord& record : records_)
        for (const std::vector<TickRecord>& other : others_) {
            const TickRecord* there = session::recordAt(other, record.tick);
            if (there == nullptr || (there->status & kEngaged) == 0) record.status &= ~std::uint32_t{kEngaged};
        }
    std::int64_t cycles = 0;  // exact, unlike a sum of times
    bool engaged = false;
    for (const TickRecord& record : records_) {
        if (!times_.empty()) cycles += record.periods;
        const double time = static_cast<double>(cycles) * kTickSeconds;
        times_.push_back(time);
        if (!engaged && (record.status & kEngaged) != 0) {
            engaged = true;
            go_ = time;
        }
    }
    if (!scene_ || !scene_->picking) return;
    PartPoses poses(*scene_);
    for (std::size_t i = 0; i < records_.size(); i += kEvery) {
        kept_.push_back(poses);
        poses = after(std::move(poses), i, std::min(records_.size(), i + kEvery));
    }
    placeParts();
}

/// The poses after the records from `from` to before `to`.
PartPoses Playback::after(PartPoses poses, std::size_t from, std::size_t to) const {
    std::vector<const TickRecord*> hands(1 + others_.size());
    for (std::size_t i = from; i < to; ++i) {
        hands[0] = &records_[i];
        for (std::size_t k = 0; k < others_.size(); ++k) hands[k + 1] = session::recordAt(others_[k], records_[i].tick);
        poses.follow(hands);
    }
    return poses;
}

void Playback::placeParts() {
    if (kept_.empty()) return;
    const std::size_t stretch = at_ / kEvery;
    poses_ = after(kept_[stretch], stretch * kEvery, at_ + 1);
}

void Playback::seek(double time) {
    time_ = std::clamp(time, 0.0, length());
    const auto later = std::upper_bound(times_.begin(), times_.end(), time_);
    at_ = later == times_.begin() ? 0 : static_cast<std::size_t>(later - times_.begin()) - 1;
    placeParts();
}

std::vector<std::optional<TickRecord>> Playback::others() const {
    std::vector<std::optional<TickRecord>> ticks;
    for (const std::vector<TickRecord>& records : others_) {
        const TickRecord* there = session::recordAt(records, record().tick);
        ticks.push_back(there != nullptr ? std::optional(*there) : std::nullopt);
    }
    return ticks;
}

void Playback::play(bool plays) {
    if (plays && time_ >= length()) seek(0.0);
    plays_ = plays;
}

bool Playback::pass(double seconds) {
    if (!plays_) return false;
    seek(time_ + speed_ * seconds);
    if (time_ >= length()) plays_ = false;
    return true;
}

template <class Value>
std::vector<Trace::Span> Playback::columnsOf(std::size_t columns, const Value& value) const {
    std::vector<Trace::Span> spans(columns);
    std::vector<bool> met(columns, false);
    for (std::size_t i = 0; i < records_.size(); ++i) {
        const double share = length() > 0.0 ? times_[i] / length() : 0.0;
        const auto column = std::min(columns - 1, static_cast<std::size_t>(share * static_cast<double>(columns)));
        const auto v = static_cast<float>(value(records_[i]));
        Trace::Span& span = spans[column];
        span = met[column] ? Trace::Span{std::min(span.low, v), std::max(span.high, v)} : Trace::Span{v, v};
        met[column] = true;
    }
    // Fewer ticks than columns: what was newest holds.
    for (std::size_t column = 1; column < columns; ++column)
        if (!met[column]) spans[column] = spans[column - 1];
    return spans;
}

std::vector<Trace::Span> Playback::forces(std::size_t columns) const { return columnsOf(columns, forceOf); }

std::vector<Trace::Span> Playback::depths(std::size_t columns) const {
    return columnsOf(columns, [](const TickRecord& r) { return 1e3 * static_cast<double>(r.hand_depth_m); });
}

std::vector<Trace::Span> Playback::overlaps(std::size_t columns) const {
    return columnsOf(columns, [](const TickRecord& r) { return 1e3 * static_cast<double>(r.proxy_depth_m); });
}

double forceOf(const TickRecord& record) {
    return static_cast<double>(Eigen::Vector3f(record.force_N[0], record.force_N[1], record.force_N[2]).norm());
}

}  // namespace passung::presenter
