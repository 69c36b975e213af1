#pragma once

#include <cstdint>

#include "core/base/tick_record.h"
#include "study/measures/measures.h"

namespace passung::measures {

/// The way of the proxy's origin through a passage, record by record. It enters where it crosses the plane z = 0 from
/// above, or from less than 0.2 mm below, not farther than half the width from the z axis; it is in the passage until
/// it leaves upwards or to a side; it is through once it gets from the passage below z = -length. Whoever leaves has to
/// enter anew.
class PassageWatch {
public:
    PassageWatch(const PassageFacts& facts, const Pose& X_WT) : facts_(facts), X_TW_(X_WT.inverse()) {}

    void follow(const TickRecord& record);

    bool inside() const { return inside_; }
    bool through() const { return through_; }
    std::int64_t entries() const { return entries_; }

private:
    PassageFacts facts_;
    Pose X_TW_;
    bool above_ = false;  // at the record before
    bool inside_ = false;
    bool through_ = false;
    std::int64_t entries_ = 0;
};

}  // namespace passung::measures
