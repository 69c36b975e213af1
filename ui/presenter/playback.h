#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/base/tick_record.h"
#include "ui/presenter/drawn_scene.h"
#include "ui/presenter/part_poses.h"
#include "ui/presenter/trace.h"

namespace passung::presenter {

/// A recorded attempt that is shown once more. Times in seconds of the attempt; a missed cycle takes its time.
class Playback {
public:
    /// `others`: records of the other hands. @pre records not empty, all ascending
    Playback(std::vector<TickRecord> records, std::shared_ptr<const DrawnScene> scene,
             std::vector<std::vector<TickRecord>> others = {});

    double length() const { return times_.back(); }
    double time() const { return time_; }
    /// When contact was first rendered: the trial's beginning; 0 if it never was.
    double go() const { return go_; }
    void seek(double time);

    bool plays() const { return plays_; }
    /// At the end it begins anew.
    void play(bool plays);
    double speed() const { return speed_; }
    void setSpeed(double speed) { speed_ = speed; }
    /// So much time has passed for who looks. False: nothing moves.
    bool pass(double seconds);

    /// The newest tick at that time.
    const TickRecord& record() const { return records_[at_]; }
    /// The same of each other hand; none: no tick of it was recorded by then.
    std::vector<std::optional<TickRecord>> others() const;
    /// Where all parts are then, of a scene whose parts are picked up.
    const PartPoses& poses() const { return poses_; }
    const std::shared_ptr<const DrawnScene>& scene() const { return scene_; }

    /// The whole attempt in so many columns, the smallest and largest value of each.
    std::vector<Trace::Span> forces(std::size_t columns) const;    // [N]
    std::vector<Trace::Span> depths(std::size_t columns) const;    // of the hand [mm]
    std::vector<Trace::Span> overlaps(std::size_t columns) const;  // of the proxy [mm]

private:
    void placeParts();
    PartPoses after(PartPoses poses, std::size_t from, std::size_t to) const;
    template <class Value>
    std::vector<Trace::Span> columnsOf(std::size_t columns, const Value& value) const;

    std::vector<TickRecord> records_;
    std::vector<std::vector<TickRecord>> others_;
    std::vector<double> times_;  // of each record
    std::shared_ptr<const DrawnScene> scene_;
    std::vector<PartPoses> kept_;  // before each kEvery-th record
    PartPoses poses_;
    std::size_t at_ = 0;
    double time_ = 0.0, go_ = 0.0, speed_ = 1.0;
    bool plays_ = false;
};

double forceOf(const TickRecord& record);  // magnitude [N]

}  // namespace passung::presenter
