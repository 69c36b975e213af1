#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/base/random.h"
#include "core/base/tick_record.h"
#include "study/measures/cues.h"
#include "study/measures/detection.h"

namespace passung::sound {

/// What is to be heard in an attempt.
struct SoundPlan {
    measures::CueSettings cues;                                // only sound and masking matter
    std::optional<measures::DetectionSettings> stimulus = {};  // of a secondary task that is heard
    std::uint64_t seed = 0;                                    // of the attempt
    bool any() const { return cues.sound || cues.masking || stimulus; }
};

/// Makes the sound of an attempt from its ticks, as samples from -1 to 1:
///   knock     kKnock c (3 sin(2π f t) + 2 sin(2π 2.76 f t)) / 5, f = kKnockHz, t from the impact,
///             c: the cue's command (measures::CueSignals), which falls between the ticks as it does there
///   stimulus  kTone r sin(2π kToneHz t), r: rises to 1 and falls to 0 within kRamp, so that no click betrays it
///   masking   kNoise u, u uniform in [-1, 1) and independent: white noise, as loud as kNoise / √3
/// kKnock + kTone + kNoise < 1: nothing clips.
class Synthesis {
public:
    static constexpr double kKnock = 0.45, kTone = 0.25, kNoise = 0.25;
    static constexpr double kKnockHz = 640.0, kToneHz = 1000.0;
    static constexpr double kRamp = 0.005;  // [s]
    static constexpr double kStale = 0.1;   // [s] without a tick after which a stimulus falls silent

    /// `rate`: samples a second.
    explicit Synthesis(double rate);

    void begin(const SoundPlan& plan);
    void follow(const TickRecord& record);
    void render(std::span<float> samples);

private:
    double rate_;
    SoundPlan plan_;
    measures::CueSignals cues_;
    std::optional<measures::DetectionTask> stimulus_;
    Random noise_;
    double last_command_ = 0.0;
    double level_ = 0.0;      // of the knock
    double fall_ = 0.0;       // of it, a sample
    std::int64_t since_ = 0;  // samples since the impact
    bool on_ = false;         // the stimulus
    double ramp_ = 0.0;       // of it
    std::int64_t played_ = 0;
    std::int64_t silent_ = 0;  // samples since the newest tick
};

}  // namespace passung::sound
