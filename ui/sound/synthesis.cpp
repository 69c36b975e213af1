#include "ui/sound/synthesis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace passung::sound {

namespace {

constexpr double kSecondPartial = 2.76;   // of a bar that is free at both ends
constexpr double kStrike = 1.0 + 1.0e-6;  // a command above what it has fallen to: another impact

double wave(double hertz, std::int64_t sample, double rate) {
    return std::sin(2.0 * std::numbers::pi * hertz * static_cast<double>(sample) / rate);
}

}  // namespace

Synthesis::Synthesis(double rate) : rate_(rate), cues_({}), noise_(0) {}

void Synthesis::begin(const SoundPlan& plan) {
    plan_ = plan;
    cues_ = measures::CueSignals(plan.cues);
    stimulus_.reset();
    if (plan.stimulus) stimulus_.emplace(*plan.stimulus, plan.seed);
    noise_ = Random(plan.seed);
    last_command_ = level_ = 0.0;
    fall_ = std::exp(-1.0 / (plan.cues.sound_decay * rate_));
    on_ = false;
}

void Synthesis::follow(const TickRecord& record) {
    silent_ = 0;
    const double command = cues_.at(record).sound;
    if (command > kStrike * last_command_) {
        level_ = std::max(level_, command);
        since_ = 0;
    }
    last_command_ = command;
    if (!stimulus_) return;
    stimulus_->follow(record);
    on_ = stimulus_->isOn();
}

void Synthesis::render(std::span<float> samples) {
    const double ramp_step = 1.0 / (kRamp * rate_);
    for (float& sample : samples) {
        const bool stale = static_cast<double>(silent_++) > kStale * rate_;
        ramp_ = std::clamp(ramp_ + (on_ && !stale ? ramp_step : -ramp_step), 0.0, 1.0);
        const double knock = 0.6 * wave(kKnockHz, since_, rate_) + 0.4 * wave(kSecondPartial * kKnockHz, since_, rate_);
        double sum = kKnock * level_ * knock + kTone * ramp_ * wave(kToneHz, played_, rate_);
        if (plan_.cues.masking) sum += kNoise * noise_.uniform(-1.0, 1.0);
        sample = static_cast<float>(sum);
        level_ *= fall_;
        ++since_;
        ++played_;
    }
}

}  // namespace passung::sound
