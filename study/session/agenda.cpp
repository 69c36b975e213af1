#include "study/session/agenda.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/base/assert.h"

namespace passung::session {

Agenda::Agenda(std::vector<design::PlannedTrial> trials)
    : trials_(std::move(trials)), todo_(trials_.size()), needless_(trials_.size()) {
    std::iota(todo_.begin(), todo_.end(), std::size_t{0});
}

std::deque<std::size_t>::const_iterator Agenda::first() const {
    return std::find_if(todo_.begin(), todo_.end(), [&](std::size_t place) { return !needless_[place]; });
}

std::vector<design::PlannedTrial> Agenda::remaining() const {
    std::vector<design::PlannedTrial> trials;
    for (const std::size_t place : todo_)
        if (!needless_[place]) trials.push_back(trials_[place]);
    return trials;
}

std::size_t Agenda::leftOut() const {
    return static_cast<std::size_t>(
        std::count_if(todo_.begin(), todo_.end(), [&](std::size_t place) { return needless_[place]; }));
}

void Agenda::end(Then then) {
    PASSUNG_ASSERT(!empty());
    const std::size_t place = next();
    todo_.erase(first());
    if (then == Then::Done)
        history_.push_back(place);
    else
        insert(place, then);
}

bool Agenda::isOver(std::size_t place) const {
    return std::find(history_.begin(), history_.end(), place) != history_.end();
}

void Agenda::redo(std::size_t place, Then then) {
    if (then == Then::Done) return;
    std::erase(history_, place);
    std::erase(todo_, place);
    needless_[place] = false;
    insert(place, then);
}

void Agenda::insert(std::size_t place, Then then) {
    const std::int64_t block = trials_[place].block_index;
    auto after = todo_.rend();  // the last one of its block
    if (then == Then::RepeatAtBlockEnd)
        after = std::find_if(todo_.rbegin(), todo_.rend(),
                             [&](std::size_t later) { return trials_[later].block_index == block; });
    todo_.insert(after.base(), place);
}

}  // namespace passung::session
