#include "study/run/log/logged_sink.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

namespace passung::run {

namespace {

/// Kinds of events that tell of the machine or of what the experimenter wanted, none of a participant.
constexpr std::string_view kTold[] = {"command_", "session_", "swap_device", "device_", "clock_"};

bool isTold(std::string_view event) {
    return std::any_of(std::begin(kTold), std::end(kTold),
                       [event](std::string_view kind) { return event.starts_with(kind); });
}

std::string healthText(const session::AttemptEnd& end) {
    const session::LoopHealth& health = end.health;
    std::string text =
        fmt::format("loop {}, {} ticks, {} records dropped", health.loop, health.ticks, health.dropped_records);
    if (end.timing_measured)
        text += fmt::format(", {} cycles missed, computed in mean {:.1f} p99 {:.1f} p99.9 {:.1f} max {:.1f} µs",
                            health.overruns, health.mean_us, health.p99_us, health.p999_us, health.max_us);
    if (const auto& shown = health.presentation)
        text += fmt::format(", {} pictures, their age p50 {:.0f} p99 {:.0f} max {:.0f} µs, sound {}", shown->frames,
                            shown->frame_age_median_us, shown->frame_age_p99_us, shown->frame_age_max_us, shown->sound);
    return text;
}

}  // namespace

template <class T>
Result<T> LoggedSink::checked(const char* what, Result<T> result) {
    if (!result && log_ != nullptr) log_->fail(fmt::format("store: {}", what), result.errors());
    return result;
}

Result<session::AttemptId> LoggedSink::startAttempt(const session::AttemptStart& start) {
    auto attempt = checked("an attempt cannot begin", sink_.startAttempt(start));
    if (attempt && log_ != nullptr)
        log_->tell(fmt::format("attempt {} begins: trial {}, its attempt {}", static_cast<std::int64_t>(*attempt),
                               start.trial_index, start.attempt_no));
    return attempt;
}

void LoggedSink::appendRecords(session::AttemptId attempt, std::size_t hand, std::span<const TickRecord> records) {
    sink_.appendRecords(attempt, hand, records);
}

void LoggedSink::appendEvent(const session::Event& event) {
    if (log_ != nullptr && isTold(event.event)) log_->tell(fmt::format("event {} ({})", event.event, event.source));
    sink_.appendEvent(event);
}

Result<Done> LoggedSink::finishAttempt(session::AttemptId attempt, const session::AttemptEnd& end) {
    auto done = checked("an attempt cannot end", sink_.finishAttempt(attempt, end));
    if (!done || log_ == nullptr) return done;
    const std::string text = fmt::format("attempt {} stored: {}", static_cast<std::int64_t>(attempt), healthText(end));
    const bool healthy = end.health.overruns == 0 && end.health.dropped_records == 0;
    healthy ? log_->tell(text) : log_->warn(text);
    return done;
}

Result<Done> LoggedSink::storeQuestionnaire(const session::QuestionnaireRun& run) {
    return checked("a questionnaire", sink_.storeQuestionnaire(run));
}

Result<Done> LoggedSink::reorder(const session::Reordering& change) {
    return checked("a change of order", sink_.reorder(change));
}

Result<Done> LoggedSink::addNote(const std::string& author, const std::string& text, std::int64_t t_ns) {
    return checked("a note", sink_.addNote(author, text, t_ns));
}

Result<Done> LoggedSink::finishSession(bool complete, std::int64_t end_ns) {
    return checked("the session's end", sink_.finishSession(complete, end_ns));
}

}  // namespace passung::run
