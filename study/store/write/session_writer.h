#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "study/measures/period_clock.h"
#include "study/session/trial_sink.h"
#include "study/store/samples/sample_codec.h"
#include "study/store/schema/utc_clock.h"

namespace passung::store {

class WriterThread;
class Database;

/// Writes one session. Records are gathered into chunks and stored while the attempt runs; the transaction that ends
/// an attempt (outcome, measures, timing and last chunk together) is on the disk when finishAttempt returns.
/// Whatever could not be stored before makes finishAttempt fail, and the attempt then stays without an outcome.
/// Used by one thread, never the tick's: a full queue makes it wait.
class SessionWriter : public session::TrialSink {
public:
    /// Rows that the session's creation made.
    struct Rows {
        std::string session_id;
        std::int64_t segment_id = 0;
        std::vector<std::int64_t> tick_stream_ids;     // of each hand
        std::optional<std::int64_t> timing_stream_id;  // only where computing times are measured
        // By their names, from the first tick in a scene that calls for them on
        std::map<std::string, std::int64_t> extra_stream_ids = {};
    };

    SessionWriter(WriterThread& thread, Rows rows, UtcClock clock);
    ~SessionWriter() override;

    Result<session::AttemptId> startAttempt(const session::AttemptStart& start) override;
    void appendRecords(session::AttemptId attempt, std::size_t hand, std::span<const TickRecord> records) override;
    void appendEvent(const session::Event& event) override;
    Result<Done> finishAttempt(session::AttemptId attempt, const session::AttemptEnd& end) override;
    Result<Done> storeQuestionnaire(const session::QuestionnaireRun& run) override;
    Result<Done> reorder(const session::Reordering& change) override;
    Result<Done> addNote(const std::string& author, const std::string& text, std::int64_t t_ns) override;
    /// A session is stored as complete only if also every planned main trial has a valid attempt that ended by its own
    /// rules; else it is aborted and its slot free again.
    Result<Done> finishSession(bool complete, std::int64_t end_ns) override;

private:
    struct HandRecords {
        std::vector<TickRecord> pending;  // not yet handed to the writer thread
        measures::PeriodClock clock;      // up to the last record that was handed over
    };
    struct OpenAttempt {
        session::AttemptId id{};
        std::int64_t trial_index = 0;
        std::int64_t start_ns = 0;
        std::vector<HandRecords> hands;
    };

    // in the writer thread; `clock` stands at the record before the first one
    void insertChunks(const Database& database, std::int64_t attempt_id, std::size_t hand, std::int64_t start_ns,
                      measures::PeriodClock clock, std::span<const TickRecord> records);
    void insertChunk(const Database& database, std::int64_t stream_id, std::int64_t chunk_no, std::int64_t attempt_id,
                     std::int64_t t0_ns, const Chunk& chunk);
    std::int64_t extraStream(const Database& database, Extra extra, std::size_t hand);
    void storeEnd(const Database& database, const OpenAttempt& attempt, const session::AttemptEnd& end);
    void throwFailure();
    template <class Work>
    void postGuarded(Work work);
    /// UTC of what happens now; that the machine's clock was set back is an event.
    std::string stamp(std::int64_t t_ns);
    std::optional<std::string> measuredStamp(std::int64_t t_ns);  // none in virtual time

    WriterThread& thread_;
    Rows rows_;
    UtcClock clock_;
    std::optional<OpenAttempt> open_;
    std::int64_t next_chunk_ = 0;  // writer thread only
    std::string failure_;          // writer thread only: the first thing that could not be stored
};

}  // namespace passung::store
