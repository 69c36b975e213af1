#include "study/measures/detection.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace passung::measures {
namespace {

constexpr std::array<const char*, 4> kResultNames = {"hit", "miss", "false_alarm", "not_scored"};

double ticks(double seconds) noexcept { return seconds / kTickSeconds; }

std::uint64_t streamOf(std::uint64_t attempt_seed) noexcept {
    std::uint64_t state = attempt_seed ^ fnv1a64("secondary");
    return splitmix64(state);
}

std::size_t count(const std::vector<Detection>& detections, DetectionResult result) {
    return static_cast<std::size_t>(
        std::count_if(detections.begin(), detections.end(), [&](const Detection& d) { return d.result == result; }));
}

}  // namespace

const char* detectionResultName(DetectionResult result) { return kResultNames[static_cast<std::size_t>(result)]; }

std::optional<DetectionResult> detectionResultNamed(std::string_view name) {
    for (std::size_t i = 0; i < kResultNames.size(); ++i)
        if (kResultNames[i] == name) return static_cast<DetectionResult>(i);
    return std::nullopt;
}

StimulusTimes::StimulusTimes(const DetectionSettings& settings, std::uint64_t attempt_seed) noexcept
    : least_(ticks(settings.least_interval)), most_(ticks(settings.most_interval)), random_(streamOf(attempt_seed)) {
    advance();
}

void StimulusTimes::advance() noexcept {
    next_ += std::max<std::int64_t>(1, std::llround(random_.uniform(least_, most_)));
}

DetectionTask::DetectionTask(const DetectionSettings& settings, std::uint64_t attempt_seed)
    : settings_(settings), times_(settings, attempt_seed) {}

void DetectionTask::follow(const TickRecord& record) {
    const std::int64_t time = clock_.at(record);
    // Lit until answered or for its duration; the next one ends it as well.
    if (current_) {
        Detection& shown = all_[*current_];
        const std::int64_t over = *shown.stimulus + std::llround(ticks(settings_.duration));
        if (!shown.off && time >= over) shown.off = time;
    }
    for (; record.tick >= times_.next(); times_.advance()) {
        if (current_ && !all_[*current_].off) all_[*current_].off = time;
        current_ = all_.size();
        all_.push_back({DetectionResult::Miss, time, {}, {}});
    }
    const bool down = (record.input_flags >> (7 + settings_.button) & 1u) != 0;
    const bool pressed = known_ && down && !down_;
    known_ = true;
    down_ = down;
    if (!pressed) return;
    if (current_ && !all_[*current_].response) {
        Detection& shown = all_[*current_];
        const auto since = static_cast<double>(time - *shown.stimulus);
        if (since >= ticks(settings_.earliest) && since <= ticks(settings_.latest)) {
            shown.result = DetectionResult::Hit;
            shown.response = time;
            if (!shown.off) shown.off = time;
            return;
        }
    }
    all_.push_back({DetectionResult::FalseAlarm, {}, {}, time});
}

std::vector<Detection> DetectionTask::detections(std::optional<std::int64_t> start, std::int64_t end) const {
    std::vector<Detection> result;
    for (Detection detection : all_) {
        const std::int64_t time = detection.stimulus.value_or(detection.response.value_or(0));
        if (time > end) continue;  // what the loop still did after the trial
        if (detection.off && *detection.off > end) detection.off = end;
        if (detection.stimulus && detection.response && *detection.response > end) {
            detection.response.reset();
            detection.result = DetectionResult::Miss;
        }
        const bool cut =
            detection.result == DetectionResult::Miss && static_cast<double>(end - time) < ticks(settings_.latest);
        if (!start || time < *start || cut) detection.result = DetectionResult::NotScored;
        if (detection.stimulus && !detection.off) detection.off = end;
        result.push_back(detection);
    }
    return result;
}

const std::vector<MeasureDefinition>& detectionDefinitions() {
    static const std::vector<MeasureDefinition> all = {
        {"secondary_stimuli", "Stimuli of the secondary task", "1",
         "number of hits and misses: stimuli with an onset from the start tick to the end tick that were answered by "
         "then, or whose last moment for a response was not after it; empty without the task"},
        {"secondary_hit_rate", "Share of stimuli that were answered", "1", "hits / secondary_stimuli; empty for none"},
        {"secondary_response_time_s", "Mean response time of the secondary task", "s",
         "mean over the hits of the time from onset to response; the response is the first press from "
         "secondary.response_min_ms to response_max_ms after the onset; time: as for the trial time"},
        {"secondary_false_alarms", "Presses that answer no stimulus", "1",
         "presses from the start tick to the end tick that are no response; empty without the task"},
    };
    return all;
}

std::vector<Value> detectionValues(const std::vector<Detection>* detections) {
    std::array<std::optional<double>, 4> values;
    if (detections != nullptr) {
        const auto hits = static_cast<double>(count(*detections, DetectionResult::Hit));
        const double stimuli = hits + static_cast<double>(count(*detections, DetectionResult::Miss));
        std::int64_t periods = 0;
        for (const Detection& d : *detections)
            if (d.result == DetectionResult::Hit) periods += *d.response - *d.stimulus;
        values[0] = stimuli;
        if (stimuli > 0.0) values[1] = hits / stimuli;
        if (hits > 0.0) values[2] = static_cast<double>(periods) / 1000.0 / hits;
        values[3] = static_cast<double>(count(*detections, DetectionResult::FalseAlarm));
    }
    std::vector<Value> result;
    for (std::size_t i = 0; i < values.size(); ++i) result.push_back({detectionDefinitions()[i].name, values[i]});
    return result;
}

}  // namespace passung::measures
