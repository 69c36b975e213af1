#include "ui/presenter/quality_search.h"

#include <algorithm>

#include "core/base/assert.h"

namespace passung::presenter {

namespace {

// Of a picture [s]: what a display of 30 Hz takes is enough, although it is not even to the millisecond.
constexpr double kLongest = 1.05 / (QualitySearch::kWanted * QualitySearch::kReserve);

}  // namespace

QualitySearch::QualitySearch(bool shadows) {
    if (shadows) candidates_ = {{true, 4, 1.0}, {true, 1, 1.0}};
    candidates_.push_back({false, 4, 1.0});
    for (const double scale : {1.0, 0.85, 0.7, 0.6, 0.5}) candidates_.push_back({false, 1, scale});
}

void QualitySearch::take(double seconds) {
    PASSUNG_ASSERT(!done_);
    if (++taken_ <= kFirst) return;
    seconds_.push_back(seconds);
    const auto slow = std::count_if(seconds_.begin(), seconds_.end(), [](double s) { return s > kLongest; });
    const bool decided = 2 * static_cast<std::size_t>(slow) > kTried;  // the others cannot move the median any more
    if (seconds_.size() == kTried || (decided && at_ + 1 < candidates_.size())) judge();
}

void QualitySearch::judge() {
    std::sort(seconds_.begin(), seconds_.end());
    const double median = seconds_[seconds_.size() / 2];
    reached_ = 1.0 / std::max(median, 1e-6);
    done_ = median <= kLongest || at_ + 1 == candidates_.size();
    if (done_) return;
    ++at_;
    taken_ = 0;
    seconds_.clear();
}

}  // namespace passung::presenter
