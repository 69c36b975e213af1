#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "study/design/trial_order.h"

namespace passung::session {

/// What is to become of a trial whose attempt has ended.
enum class Then { Done, RepeatNow, RepeatAtBlockEnd };

/// The trials of a session: which is next, which are over. A trial is known by its place in the plan, from 0; every
/// place is to do at most once. Nothing here knows of attempts: those stay in the data whatever happens to the order.
class Agenda {
public:
    /// All trials are to do, in this order.
    explicit Agenda(std::vector<design::PlannedTrial> trials);

    std::size_t planned() const { return trials_.size(); }
    std::size_t finished() const { return trials_.size() - todo_.size(); }
    std::size_t leftOut() const;  // of those to do
    bool empty() const { return first() == todo_.end(); }
    std::size_t next() const { return *first(); }  // @pre not empty()
    const design::PlannedTrial& trial(std::size_t place) const { return trials_[place]; }
    /// All that are still to do, the next one first.
    std::vector<design::PlannedTrial> remaining() const;

    /// The next trial has had an attempt, or (Done) is left out. RepeatAtBlockEnd: after what is left of its block.
    /// @pre not empty()
    void end(Then then);

    /// Trials that are still to do and for which this holds are passed over until it is asked again; nobody goes back
    /// to them.
    template <class Needless>
    void leaveOut(Needless needless) {
        for (const std::size_t place : todo_) needless_[place] = needless(trials_[place]);
    }

    /// Tells whether any trial is over.
    bool canGoBack() const { return !history_.empty(); }
    /// The trial that is over last. @pre canGoBack()
    std::size_t last() const { return history_.back(); }

    /// All that are over, in time.
    const std::vector<std::size_t>& over() const { return history_; }
    bool isOver(std::size_t place) const;
    /// The trial is next, whether it was over or to come later.
    void bring(std::size_t place) { redo(place, Then::RepeatNow); }
    /// The trial is to do again, now or at the end of its block. Done: nothing changes.
    void redo(std::size_t place, Then then);

private:
    void insert(std::size_t place, Then then);
    std::deque<std::size_t>::const_iterator first() const;  // that is needed

    std::vector<design::PlannedTrial> trials_;
    std::deque<std::size_t> todo_;      // also those that are not needed as things are
    std::vector<bool> needless_;        // by place
    std::vector<std::size_t> history_;  // done or skipped, in time
};

}  // namespace passung::session
