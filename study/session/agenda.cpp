#include "study/session/agenda.h"

#include <algorithm>
#include <utility>

#include "core/base/assert.h"

namespace passung::session {

Agenda::Agenda(std::vector<design::PlannedTrial> trials, const std::vector<bool>& over) : trials_(std::move(trials)) {
    PASSUNG_ASSERT(over.empty() || over.size() == trials_.size());
    for (std::size_t place = 0; place < trials_.size(); ++place) {
        if (!over.empty() && over[place])
            history_.push_back(place);
        else
            todo_.push_back(place);
    }
}

void Agenda::end(Then then) {
    PASSUNG_ASSERT(!empty());
    if (then == Then::RepeatNow) return;
    const std::size_t place = todo_.front();
    todo_.pop_front();
    if (then == Then::Done) {
        history_.push_back(place);
        return;
    }
    const std::int64_t block = trials_[place].block_index;
    const auto other = std::find_if(todo_.begin(), todo_.end(),
                                    [&](std::size_t later) { return trials_[later].block_index != block; });
    todo_.insert(other, place);
}

void Agenda::goBack() {
    PASSUNG_ASSERT(canGoBack());
    todo_.push_front(history_.back());
    history_.pop_back();
}

}  // namespace passung::session
