#pragma once

#include <optional>

#include "study/person/real_parts.h"
#include "study/session/trial_timer.h"

namespace passung::run {

/// Times a simulated person's trials with real parts by person::realTrial(). Its commands are logged with the source
/// "simulated".
class SimulatedTimer final : public session::TrialTimer {
public:
    explicit SimulatedTimer(const person::SimulatedPerson& person) : person_(person) {}

    void begin(const plan::Condition& condition, std::uint64_t seed, std::int64_t trials_before) override;
    std::optional<session::Command> commandAt(std::int64_t periods) override;

private:
    static constexpr std::int64_t kStart = 1000;  // periods after the attempt's first tick

    person::SimulatedPerson person_;
    person::RealTrial trial_;
    bool started_ = false, ended_ = false;
};

}  // namespace passung::run
