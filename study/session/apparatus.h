#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/device_description.h"
#include "core/base/result.h"
#include "core/base/tick_record.h"
#include "study/measures/measures.h"
#include "study/plan/study_plan.h"

namespace passung::session {

/// What the controller took in through one pair of the held part and an obstacle during an attempt.
struct ContactEnergy {
    std::string obstacle;     // its part's name; empty: what no obstacle pushed
    double taken_in_J = 0.0;  // at the end
    double least_J = 0.0;     // at any tick, ≤ 0
    std::string hand = {};    // that holds the part; empty: the first
};

/// What a window gave the participant during one attempt. The age of a picture: from the reading of the device for the
/// newest tick that it shows until the display gets it; of pictures that show no newer tick than the one before none is
/// known.
struct Presentation {
    std::string drawn_pose;   // of the held part: "proxy", "device"
    std::int64_t frames = 0;  // of known age
    double frame_age_median_us = 0, frame_age_p99_us = 0, frame_age_max_us = 0;
    std::string sound = "none";  // "none": the condition has nothing to be heard; "played"; "silent": had no output
    std::string sound_output;    // its name
    double sound_delay_us = 0;   // of what is played: the length of the output's buffer
    std::optional<std::int64_t> cue_frames;  // of the frames: drawn with the visual cue above 0; none: not counted
};

/// What of a condition's feedback reached the participant during one attempt: acknowledged by an actuator, drawn,
/// played, or handed to the senses of a simulated one. A tick or picture in which a cue stood at nothing does not
/// count.
struct Delivered {
    std::int64_t force = 0;      // ticks with a wrench, on a device that can push a hand
    std::int64_t visual = 0;     // pictures
    std::int64_t vibration = 0;  // ticks, as the others
    std::int64_t sound = 0;
    std::int64_t masking = 0;
};

/// How well the loop kept its rate during one attempt.
struct LoopHealth {
    std::string loop;  // "virtual", "real-time fifo", "real-time normal"
    std::int64_t ticks = 0;
    double mean_us = 0, sd_us = 0, p99_us = 0, p999_us = 0, max_us = 0;  // computing time of a tick, by the wall clock
    double processor_mean_us = 0, processor_p99_us = 0, processor_p999_us = 0, processor_max_us = 0;  // of its thread
    std::int64_t overruns = 0;  // cycles missed because an earlier one ended after its deadline; 0 in virtual time
    std::int64_t dropped_records = 0;
    std::vector<std::int64_t> histogram;        // ticks per bucket, bucket i: [2^i, 2^(i+1)) × 0.1 µs
    std::uint64_t state_hash = 0;               // over every exact output of the attempt; equal on replay
    std::vector<ContactEnergy> contact_energy;  // of each obstacle in the order of the scene, then of none
    std::optional<Presentation> presentation;   // none: no window showed the attempt
    Delivered delivered;
};

/// Something that happened to a device that lives as long as the session.
struct DeviceNews {
    std::string event;  // name and payload in the data
    std::string payload_json;
    std::string loss;  // why what runs on the device is over, for people; empty: it is not
};

/// One stage of the tick and why it runs, or does not.
struct StageNote {
    std::string name;
    std::string reason;
    bool runs = true;
};

/// The session's view of loop, device and scene. It never blocks longer than it is told to.
class Apparatus {
public:
    virtual ~Apparatus() = default;

    virtual const DeviceDescription& device() const = 0;

    /// Builds the scene of `condition` and everything that a trial needs; may take seconds. Motors stay off.
    /// `seed` drives everything random in a simulated device and hand for this attempt; a simulated person learns from
    /// the trials that the session's plan has before this one.
    virtual Result<std::vector<StageNote>> prepare(const plan::Condition& condition, std::uint64_t seed,
                                                   std::int64_t trials_before) = 0;

    /// Lets so many periods pass while no loop runs: at once in virtual time.
    virtual void wait(std::int64_t ticks) = 0;

    /// Starts the loop at tick 0.
    virtual void start() = 0;

    /// Lets `ticks` more ticks happen: computes them in virtual time, waits for them in real time.
    virtual void advance(std::int64_t ticks) = 0;

    /// Takes the oldest records of the first hand out of the ring; call until it returns 0. Consecutive ticks unless
    /// dropped.
    virtual std::size_t takeRecords(std::span<TickRecord> into) = 0;

    /// The same of another hand of the condition's scene, `hand` from 1.
    virtual std::size_t takeRecordsOf(std::size_t hand, std::span<TickRecord> into) {
        static_cast<void>(hand), static_cast<void>(into);
        return 0;
    }

    /// Stops the loop with a zero wrench and says how it went.
    virtual LoopHealth stop() = 0;

    /// Measures by exact geometry how deep the held parts and the obstacles reached into each other at these ticks of
    /// the attempt that stop() ended, as it was shown, and fills in depth and bound. `trial`: its records from the
    /// start tick on, where parts are picked up from tick 0 on; `others`: those of the other hands. False: nothing can
    /// be measured. The same records give the same; it takes no longer than a pause between trials bears.
    virtual bool measureOverlaps(std::span<const TickRecord> trial, std::span<const std::vector<TickRecord>> others,
                                 std::span<measures::TickOverlap> ticks) {
        static_cast<void>(trial), static_cast<void>(others), static_cast<void>(ticks);
        return false;
    }

    /// Emergency: a zero wrench after the running tick, and no tick more until rearm(), not even of an attempt that is
    /// started meanwhile. From any thread.
    virtual void halt() = 0;
    virtual void rearm() = 0;

    /// What happened to the devices since the last call, each once.
    virtual std::vector<DeviceNews> takeDeviceNews() { return {}; }
    /// Which device is not ready for a trial, and why; empty: all are. `or_there`: one that rearm() can make ready will
    /// do.
    virtual std::string deviceNotReady(bool or_there) const {
        static_cast<void>(or_there);
        return {};
    }
};

}  // namespace passung::session
