#pragma once

#include "study/run/log/study_log.h"
#include "study/session/trial_sink.h"

namespace passung::run {

/// Passes a session's data on to another sink and tells the log how the loop kept its rate in each attempt, what kinds
/// of commands came, and what could not be stored; of the data itself nothing.
class LoggedSink final : public session::TrialSink {
public:
    /// `log` null: none.
    LoggedSink(session::TrialSink& sink, StudyLog* log) : sink_(sink), log_(log) {}

    Result<session::AttemptId> startAttempt(const session::AttemptStart& start) override;
    void appendRecords(session::AttemptId attempt, std::size_t hand, std::span<const TickRecord> records) override;
    void appendEvent(const session::Event& event) override;
    Result<Done> finishAttempt(session::AttemptId attempt, const session::AttemptEnd& end) override;
    Result<Done> storeQuestionnaire(const session::QuestionnaireRun& run) override;
    Result<Done> reorder(const session::Reordering& change) override;
    Result<Done> addNote(const std::string& author, const std::string& text, std::int64_t t_ns) override;
    Result<Done> finishSession(bool complete, std::int64_t end_ns) override;

private:
    template <class T>
    Result<T> checked(const char* what, Result<T> result);

    session::TrialSink& sink_;
    StudyLog* log_;
};

}  // namespace passung::run
