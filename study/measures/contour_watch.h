#pragma once

#include <vector>

#include "core/base/tick_record.h"
#include "study/measures/measures.h"

namespace passung::measures {

/// How far a line has been followed, record by record. The place on the line is the point nearest to the proxy's origin
/// among those from the place so far up to `reach` ahead along the line; it moves there if that point is not farther
/// away than `reach`, and never back. Following begins within `reach` of the first point.
class ContourWatch {
public:
    ContourWatch(const ContourFacts& facts, const Pose& X_WT);

    void follow(const TickRecord& record);

    /// Share of the line's length, 0 … 1.
    double progress() const { return place_ / length_; }
    /// Tells whether the proxy's origin is within reach of its place at the newest record.
    bool following() const { return following_; }
    /// How far it is from its place at the newest record [m].
    double deviation() const { return deviation_; }

private:
    ContourFacts facts_;
    Pose X_TW_;
    std::vector<double> starts_;  // of the segments along the line [m]
    double length_ = 0.0;         // [m]
    double place_ = 0.0;          // [m] along the line
    bool following_ = false;
    double deviation_ = 0.0;
};

}  // namespace passung::measures
