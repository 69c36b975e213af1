#include "study/store/write/session_writer.h"

#include <array>

#include "core/base/hex_text.h"
#include "core/base/json.h"
#include "study/store/rows/assembly_step_rows.h"
#include "study/store/rows/contact_energy_rows.h"
#include "study/store/rows/delivery_rows.h"
#include "study/store/rows/event_rows.h"
#include "study/store/rows/exact_overlap_rows.h"
#include "study/store/rows/order_rows.h"
#include "study/store/rows/presentation_rows.h"
#include "study/store/rows/questionnaire_rows.h"
#include "study/store/rows/remarks.h"
#include "study/store/rows/secondary_rows.h"
#include "study/store/rows/session_json.h"
#include "study/store/rows/staircase_rows.h"
#include "study/store/schema/named_columns.h"
#include "study/store/schema/value_hash.h"
#include "study/store/write/writer_thread.h"

namespace passung::store {
namespace {

std::string histogramJson(const std::vector<std::int64_t>& histogram) {
    std::string json = "[";
    for (const std::int64_t count : histogram) {
        if (json.size() > 1) json += ',';
        json += std::to_string(count);
    }
    return json + "]";
}

void insertMeasures(const Database& database, std::int64_t attempt_id, const std::vector<measures::Value>& values) {
    Statement insert = database.prepare("INSERT INTO attempt_measure(attempt_id, measure, value_num) VALUES(?, ?, ?)");
    for (const measures::Value& value : values) insert.bind(attempt_id, value.name, value.value).run();
}

void insertTiming(const Database& database, std::int64_t attempt_id, const session::LoopHealth& health, bool measured) {
    const auto us = [measured](double value) { return measured ? std::optional(value) : std::nullopt; };
    const auto histogram = measured ? std::optional(histogramJson(health.histogram)) : std::nullopt;
    insertRow(database, "timing", Named{"attempt_id", attempt_id}, Named{"loop", health.loop},
              Named{"ticks", health.ticks}, Named{"mean_us", us(health.mean_us)}, Named{"sd_us", us(health.sd_us)},
              Named{"p99_us", us(health.p99_us)}, Named{"p999_us", us(health.p999_us)},
              Named{"max_us", us(health.max_us)}, Named{"overruns", health.overruns},
              Named{"dropped_samples", health.dropped_records}, Named{"hist_json", histogram},
              Named{"processor_mean_us", us(health.processor_mean_us)},
              Named{"processor_p99_us", us(health.processor_p99_us)},
              Named{"processor_p999_us", us(health.processor_p999_us)},
              Named{"processor_max_us", us(health.processor_max_us)});
}

/// Has every planned main trial an attempt that counts?
bool isWhole(const Database& database, const std::string& session_id) {
    Statement lacking = database.prepare(
        "SELECT 1 FROM trial_plan t WHERE t.session_id=? AND t.phase='main' AND NOT EXISTS(SELECT 1 FROM attempt a "
        "WHERE a.trial_id=t.trial_id AND a.valid AND a.outcome IN('success','failure','timeout')) LIMIT 1");
    return !lacking.bind(session_id).step();
}

/// After a whole session the slot is the participant's for good, and with the last of the protocol's sessions the
/// participant is complete. After another one a slot that is not theirs for good is free for the next participant.
void settleParticipant(const Database& database, const std::string& session_id, bool whole) {
    database
        .prepare(
            whole ? "WITH part(participant, done, wanted) AS (SELECT s.participant_id, (SELECT count(*) FROM session "
                    "c WHERE c.participant_id=s.participant_id AND c.protocol_sha256=s.protocol_sha256 AND "
                    "c.end_state='complete'), (SELECT coalesce(json_extract(expanded_json, '$.sessions'), 1) FROM "
                    "protocol_version p WHERE p.protocol_sha256=s.protocol_sha256) FROM session s WHERE "
                    "s.session_id=?) UPDATE participant SET status=iif(done<wanted, 'enrolled', 'complete'), "
                    "status_reason=iif(done<wanted, 'completed ' || done || ' of ' || wanted || ' sessions', "
                    "status_reason) FROM part WHERE participant_id=participant AND status='active'"
                  : "UPDATE participant SET status='enrolled', status_reason=(SELECT 'session ' || ordinal || "
                    "' did not complete' FROM session WHERE session_id=?1) WHERE status='active' AND "
                    "participant_id=(SELECT participant_id FROM session WHERE session_id=?1)")
        .bind(session_id)
        .run();
    database
        .prepare(std::string(whole ? "UPDATE design_slot SET state='complete'"
                                   : "UPDATE design_slot SET state='free', participant_id=NULL") +
                 " WHERE state='assigned' AND (participant_id, protocol_sha256)="
                 "(SELECT participant_id, protocol_sha256 FROM session WHERE session_id=?)")
        .bind(session_id)
        .run();
}

}  // namespace

SessionWriter::SessionWriter(WriterThread& thread, Rows rows, UtcClock clock)
    : thread_(thread), rows_(std::move(rows)), clock_(std::move(clock)) {}

SessionWriter::~SessionWriter() {
    // Jobs refer to this object: wait until none is left.
    static_cast<void>(thread_.call([](const Database&) { return Done{}; }));
}

template <class Work>
void SessionWriter::postGuarded(Work work) {
    thread_.post([this, work = std::move(work)](const Database& database) {
        try {
            work(database);
        } catch (const std::exception& error) {
            if (failure_.empty()) failure_ = error.what();
        }
    });
}

void SessionWriter::throwFailure() {
    if (failure_.empty()) return;
    const std::string failure = std::exchange(failure_, {});
    throw std::runtime_error("data could not be stored: " + failure);
}

std::string SessionWriter::stamp(std::int64_t t_ns) {
    const UtcClock::Stamp stamp = clock_.stamp(t_ns);
    if (!stamp.machine_utc.empty())
        appendEvent({.attempt = {},
                     .t_ns = t_ns,
                     .source = "session",
                     .event = "clock_set_back",
                     .payload_json = JsonObject().text("machine_utc", stamp.machine_utc).text("utc", stamp.utc).str()});
    return stamp.utc;
}

std::optional<std::string> SessionWriter::measuredStamp(std::int64_t t_ns) {
    if (!clock_.runs()) return std::nullopt;
    return stamp(t_ns);
}

Result<session::AttemptId> SessionWriter::startAttempt(const session::AttemptStart& start) {
    const std::string stages = stagesJson(start.stages);
    const auto id = thread_.call([&](const Database& database) {
        throwFailure();
        Transaction transaction(database, Durability::Normal);
        Statement trial = database.prepare("SELECT trial_id FROM trial_plan WHERE session_id=? AND trial_index=?");
        if (!trial.bind(rows_.session_id, start.trial_index).step()) {
            throw std::runtime_error("trial " + std::to_string(start.trial_index) + " is not in the session's plan");
        }
        // Not valid before it has ended.
        database
            .prepare(
                "INSERT INTO attempt(trial_id, attempt_no, segment_id, start_ns, valid, params_json, stages_json, "
                "seed) VALUES(?, ?, ?, ?, 0, ?, ?, ?)")
            .bind(trial.integer(0), start.attempt_no, rows_.segment_id, start.start_ns, start.params_json, stages,
                  start.seed)
            .run();
        const std::int64_t attempt_id = database.lastRowId();
        trial.reset();
        if (start.staircase) insertStaircaseStep(database, rows_.session_id, attempt_id, *start.staircase);
        transaction.commit();
        return attempt_id;
    });
    if (!id) return id.errors();
    open_ = OpenAttempt{session::AttemptId{*id}, start.trial_index, start.start_ns,
                        std::vector<HandRecords>(rows_.tick_stream_ids.size())};
    return open_->id;
}

void SessionWriter::insertChunk(const Database& database, std::int64_t stream_id, std::int64_t chunk_no,
                                std::int64_t attempt_id, std::int64_t t0_ns, const Chunk& chunk) {
    insertRow(database, "sample_chunk", Named{"stream_id", stream_id}, Named{"chunk_no", chunk_no},
              Named{"attempt_id", attempt_id}, Named{"first_tick", chunk.first_tick}, Named{"n", chunk.count},
              Named{"t0_ns", t0_ns}, Named{"crc32", chunk.crc32},
              Named{"data", std::span<const std::byte>(chunk.data)});
}

/// Made when it is first needed, in the manner of the hand's stream of ticks.
std::int64_t SessionWriter::extraStream(const Database& database, Extra extra, std::size_t hand) {
    const std::string name = extraStreamName(extra, hand), channels = channelsJson(extraChannels(extra));
    if (const auto known = rows_.extra_stream_ids.find(name); known != rows_.extra_stream_ids.end())
        return known->second;
    database
        .prepare(
            "INSERT INTO stream(segment_id, stream, nominal_hz, channels_json, encoding, numerics) "
            "SELECT segment_id, ?, nominal_hz, ?, encoding, numerics FROM stream WHERE stream_id=?")
        .bind(name, channels, rows_.tick_stream_ids[hand])
        .run();
    return rows_.extra_stream_ids[name] = database.lastRowId();
}

void SessionWriter::insertChunks(const Database& database, std::int64_t attempt_id, std::size_t hand,
                                 std::int64_t start_ns, measures::PeriodClock clock,
                                 std::span<const TickRecord> records) {
    while (!records.empty()) {
        const std::size_t count = consecutiveTicks(records);
        const auto run = records.first(count);
        const std::int64_t t0_ns = start_ns + clock.at(run.front()) * kTickNanoseconds;
        insertChunk(database, rows_.tick_stream_ids[hand], next_chunk_, attempt_id, t0_ns, packTicks(encodeTicks(run)));
        if (hand == 0 && rows_.timing_stream_id) {  // the hands of a tick are computed together
            insertChunk(database, *rows_.timing_stream_id, next_chunk_, attempt_id, t0_ns,
                        packTiming(encodeTiming(run)));
        }
        for (const Extra extra : kExtras)
            if (haveExtra(extra, run))
                insertChunk(database, extraStream(database, extra, hand), next_chunk_, attempt_id, t0_ns,
                            packExtra(extra, encodeExtra(extra, run)));
        for (const TickRecord& record : run) clock.at(record);
        ++next_chunk_;  // a number that a rollback leaves unused does no harm
        records = records.subspan(count);
    }
}

void SessionWriter::appendRecords(session::AttemptId attempt, std::size_t hand, std::span<const TickRecord> records) {
    if (!open_ || open_->id != attempt) {
        postGuarded([](const Database&) { throw std::runtime_error("records for an attempt that is not open"); });
        return;
    }
    auto& [pending, clock] = open_->hands.at(hand);
    pending.insert(pending.end(), records.begin(), records.end());
    std::size_t ready = 0;
    for (;;) {
        const auto rest = std::span(pending).subspan(ready);
        const std::size_t count = consecutiveTicks(rest);
        if (count == rest.size() && count < kChunkTicks) break;  // may still grow
        ready += count;
    }
    if (ready == 0) return;
    std::vector<TickRecord> chunk(pending.begin(), pending.begin() + static_cast<std::ptrdiff_t>(ready));
    pending.erase(pending.begin(), pending.begin() + static_cast<std::ptrdiff_t>(ready));
    const measures::PeriodClock before = clock;
    for (const TickRecord& record : chunk) clock.at(record);
    postGuarded(
        [this, attempt, hand, start_ns = open_->start_ns, before, chunk = std::move(chunk)](const Database& database) {
            Transaction transaction(database, Durability::Normal);
            insertChunks(database, static_cast<std::int64_t>(attempt), hand, start_ns, before, chunk);
            transaction.commit();
        });
}

void SessionWriter::appendEvent(const session::Event& event) {
    postGuarded([this, event, utc = measuredStamp(event.t_ns)](const Database& database) {
        Transaction transaction(database, Durability::Normal);
        insertEvent(database, rows_.segment_id, event, utc);
        transaction.commit();
    });
}

void SessionWriter::storeEnd(const Database& database, const OpenAttempt& attempt, const session::AttemptEnd& end) {
    const auto attempt_id = static_cast<std::int64_t>(attempt.id);
    Transaction transaction(database, Durability::Full);
    for (std::size_t hand = 0; hand < attempt.hands.size(); ++hand)
        insertChunks(database, attempt_id, hand, attempt.start_ns, attempt.hands[hand].clock,
                     attempt.hands[hand].pending);
    database
        .prepare(
            "UPDATE attempt SET end_ns=?, outcome=?, valid=?, invalid_reason=?, state_hash=?, timing_measured=? "
            "WHERE attempt_id=?")
        .bind(end.end_ns, measures::outcomeName(end.outcome), end.valid, nullIfEmpty(end.invalid_reason),
              hexText(end.health.state_hash), end.timing_measured, attempt_id)
        .run();
    insertMeasures(database, attempt_id, end.measures);
    insertDetections(database, attempt_id, attempt.start_ns, end.detections);
    if (end.staircase) storeStaircaseAnswer(database, attempt_id, *end.staircase);
    insertTiming(database, attempt_id, end.health, end.timing_measured);
    insertContactEnergy(database, attempt_id, end.health.contact_energy);
    insertExactOverlaps(database, attempt_id, end.overlaps);
    insertAssemblySteps(database, attempt_id, end.steps);
    insertDelivery(database, attempt_id, end.health.delivered);
    if (end.health.presentation) insertPresentation(database, attempt_id, *end.health.presentation);
    insertOrderSteps(database, rows_.session_id, rows_.segment_id,
                     std::array{session::OrderStep{attempt.trial_index, end.then, end.decided_by, attempt.id}});
    transaction.commit();
}

Result<Done> SessionWriter::finishAttempt(session::AttemptId attempt, const session::AttemptEnd& end) {
    if (!open_ || open_->id != attempt) {
        return Error{
            .message = "an attempt that is not open cannot end", .file = thread_.path(), .key = {}, .value = {}};
    }
    const OpenAttempt ended = std::move(*open_);
    open_.reset();
    return thread_.call([&](const Database& database) {
        throwFailure();
        storeEnd(database, ended, end);
        return Done{};
    });
}

Result<Done> SessionWriter::storeQuestionnaire(const session::QuestionnaireRun& run) {
    FormUtc utc{{}, stamp(run.completed_ns), clock_.runs()};
    utc.started = clock_.runs() ? utc.completed : clock_.at(run.started_ns);
    return thread_.call([&](const Database& database) {
        throwFailure();
        Transaction transaction(database, Durability::Full);
        insertQuestionnaireRun(database, rows_.session_id, rows_.segment_id, run, utc);
        transaction.commit();
        return Done{};
    });
}

Result<Done> SessionWriter::reorder(const session::Reordering& change) {
    return thread_.call([&](const Database& database) {
        Transaction transaction(database, Durability::Full);
        const auto discount = [&] {
            for (const session::AttemptId attempt : change.discounted)
                markInvalid(database, static_cast<std::int64_t>(attempt), change.reason);
        };
        if (!change.discounted.empty()) changeLater(database, rows_.session_id, discount);
        insertOrderSteps(database, rows_.session_id, rows_.segment_id, change.steps);
        transaction.commit();
        return Done{};
    });
}

Result<Done> SessionWriter::addNote(const std::string& author, const std::string& text, std::int64_t t_ns) {
    const std::string utc = stamp(t_ns);
    return thread_.call([&](const Database& database) {
        Transaction transaction(database, Durability::Full);
        insertNote(database, {rows_.session_id, utc, author, text});
        transaction.commit();
        return Done{};
    });
}

Result<Done> SessionWriter::finishSession(bool complete, std::int64_t end_ns) {
    const std::string ended_utc = stamp(end_ns);
    return thread_.call([&](const Database& database) {
        throwFailure();
        Transaction transaction(database, Durability::Full);
        database
            .prepare(
                "UPDATE attempt SET outcome='crashed', valid=0, invalid_reason='its data could not be stored' "
                "WHERE segment_id=? AND outcome='running'")
            .bind(rows_.segment_id)
            .run();
        const bool whole = complete && isWhole(database, rows_.session_id);
        database.prepare("UPDATE session SET ended_utc=?, end_state=? WHERE session_id=?")
            .bind(ended_utc, whole ? "complete" : "aborted", rows_.session_id)
            .run();
        database.prepare("UPDATE segment SET closed_clean=1 WHERE segment_id=?").bind(rows_.segment_id).run();
        settleParticipant(database, rows_.session_id, whole);
        sealSession(database, rows_.session_id);
        transaction.commit();
        return Done{};
    });
}

}  // namespace passung::store
