#include "study/store/read/unfinished.h"

#include <algorithm>
#include <stdexcept>

#include "core/base/tick_record.h"
#include "study/store/rows/order_rows.h"
#include "study/store/schema/sqlite.h"
#include "study/store/schema/value_hash.h"

namespace passung::store {
namespace {

std::string findSession(const Database& database, const std::string& wanted) {
    Statement find = database.prepare(
        "SELECT session_id, coalesce(end_state, ''), participant_id, ordinal, (SELECT max(o.ordinal) FROM session o "
        "WHERE o.participant_id=s.participant_id) FROM session s WHERE CASE ?1 WHEN '' THEN end_state<>'complete' "
        "ELSE session_id=?1 END ORDER BY rowid DESC LIMIT 1");
    if (!find.bind(wanted).step())
        throw std::runtime_error(wanted.empty() ? "holds no session that did not complete"
                                                : "there is no session " + wanted);
    const std::string name = find.text(2) + ", session " + find.text(3);
    if (find.text(1) == "complete") throw std::runtime_error(name + " is complete");
    if (find.integer(3) < find.integer(4))
        throw std::runtime_error(name + ": session " + find.text(4) + " has begun since");
    return find.text(0);
}

void readMeasures(const Database& database, session::StoredAttempt& attempt) {
    Statement values = database.prepare("SELECT measure, value_num FROM attempt_measure WHERE attempt_id=?");
    values.bind(static_cast<std::int64_t>(attempt.id));
    while (values.step()) attempt.measures.push_back({values.text(0), values.optionalReal(1)});
}

void readTrials(const Database& database, Unfinished& session) {
    Statement trials = database.prepare(
        "SELECT trial_index, block_index, block, trial_in_block, phase, c.position, repetition FROM trial_plan "
        "JOIN condition c USING(condition_id) WHERE session_id=? ORDER BY trial_index");
    trials.bind(session.session_id);
    while (trials.step()) {
        session.trials.push_back({trials.integer(0), trials.integer(1), trials.text(2), trials.integer(3),
                                  trials.text(4), static_cast<std::size_t>(trials.integer(5)),
                                  static_cast<int>(trials.integer(6))});
    }
    Statement attempts = database.prepare(
        "SELECT attempt_id, (SELECT count(*) FROM trial_plan b WHERE b.session_id=t.session_id AND "
        "b.trial_index<t.trial_index), attempt_no, outcome, valid, start_ns, f.staircase, f.track, f.level, "
        "f.positive, "
        "coalesce(invalid_reason, '') "
        "FROM attempt JOIN trial_plan t USING(trial_id) LEFT JOIN staircase_step f USING(attempt_id) "
        "WHERE session_id=? ORDER BY attempt_id");
    attempts.bind(session.session_id);
    while (attempts.step()) {
        session.attempts.push_back({session::AttemptId{attempts.integer(0)},
                                    static_cast<std::size_t>(attempts.integer(1)),
                                    static_cast<int>(attempts.integer(2)),
                                    measures::outcomeNamed(attempts.text(3)),
                                    attempts.integer(4) != 0,
                                    attempts.integer(5),
                                    {},
                                    {}});
        session.attempts.back().invalid_reason = attempts.text(10);
        readMeasures(database, session.attempts.back());
        if (!attempts.isNull(7) && !attempts.isNull(9))
            session.attempts.back().step =
                session::StoredStep{attempts.text(6), attempts.text(7), attempts.real(8), attempts.integer(9) != 0};
    }
}

/// Those from before forms had an id are asked again.
void readForms(const Database& database, Unfinished& session) {
    Statement forms = database.prepare(
        "SELECT json_extract(payload_json, '$.form'), t_ns FROM event JOIN segment USING(segment_id) "
        "WHERE session_id=? AND event='questionnaire_answered' AND json_extract(payload_json, '$.form') IS NOT NULL "
        "ORDER BY event_id");
    forms.bind(session.session_id);
    while (forms.step()) session.forms.push_back({forms.text(0), forms.integer(1)});
}

/// Programs before wrote it as a note.
void readNotedQuality(const Database& database, Unfinished& session) {
    Statement notes = database.prepare(
        "SELECT json_extract(payload_json, '$.text') FROM event JOIN segment USING(segment_id) WHERE session_id=? AND "
        "event='command_note' AND source='window' AND json_extract(payload_json, '$.text') IS NOT NULL "
        "ORDER BY event_id");
    notes.bind(session.session_id);
    while (notes.step())
        if (const auto quality = session::qualityOfNote(notes.text(0))) session.quality = quality;
}

/// Reads the newest event of it.
void readQuality(const Database& database, Unfinished& session) {
    Statement find = database.prepare(
        "SELECT payload_json ->> 'window_width_px', payload_json ->> 'window_height_px', payload_json ->> 'scale', "
        "payload_json ->> 'samples', payload_json ->> 'shadows', payload_json ->> 'pictures_per_s', "
        "payload_json ->> 'triangles' FROM event JOIN segment USING(segment_id) WHERE session_id=? AND event=? "
        "ORDER BY event_id DESC LIMIT 1");
    if (!find.bind(session.session_id, session::kQualityEvent).step()) return readNotedQuality(database, session);
    session::QualityFound found;
    found.width_px = static_cast<int>(find.integer(0));
    found.height_px = static_cast<int>(find.integer(1));
    found.quality = {find.integer(4) != 0, static_cast<int>(find.integer(3)), find.real(2)};
    found.pictures_per_s = find.real(5);
    found.triangles = find.integer(6);
    const bool possible = found.quality.samples >= 1 && found.quality.scale >= 0.5 && found.quality.scale <= 1.0;
    if (possible) session.quality = found;  // else it is found anew
}

/// The latest stamp of anything in the session. Such texts sort as their times.
std::string latestUtc(const Database& database, const std::string& session_id) {
    Statement find = database.prepare(
        "SELECT max(t) FROM (SELECT max(g.started_utc) t FROM segment g WHERE g.session_id=?1 UNION ALL "
        "SELECT max(e.t_utc) FROM event e JOIN segment g USING(segment_id) WHERE g.session_id=?1 UNION ALL "
        "SELECT max(completed_utc) FROM questionnaire_run WHERE session_id=?1 UNION ALL "
        "SELECT max(t_utc) FROM note WHERE session_id=?1)");
    find.bind(session_id).step();
    return find.text(0);
}

/// Days since the session's last sign of life: what session time ran on after the latest stamp of an event counts.
constexpr const char* kAgeDays =
    "julianday(?2) - max(julianday(g.utc_zero) + ?3 / 86400e9, coalesce((SELECT julianday(e.t_utc) + "
    "(?3 - e.t_ns) / 86400e9 FROM event e JOIN segment h USING(segment_id) WHERE h.session_id=?1 AND e.t_utc IS NOT "
    "NULL ORDER BY e.event_id DESC LIMIT 1), 0))";

/// The latest time of anything in the session.
std::int64_t usedTime(const Database& database, const std::string& session_id) {
    Statement find = database.prepare(
        "SELECT max(coalesce((SELECT max(a.end_ns) FROM attempt a JOIN segment g USING(segment_id) "
        "WHERE g.session_id=?1), 0), coalesce((SELECT max(e.t_ns) FROM event e JOIN segment g USING(segment_id) "
        "WHERE g.session_id=?1), 0), coalesce((SELECT max(c.t0_ns + c.n * ?2) FROM sample_chunk c JOIN stream "
        "USING(stream_id) JOIN segment g USING(segment_id) WHERE g.session_id=?1), 0))");
    find.bind(session_id, kTickNanoseconds).step();
    return find.integer(0);
}

}  // namespace

Unfinished readUnfinished(const Database& database, const std::string& session_id, const std::string& now_utc) {
    Unfinished session;
    session.session_id = findSession(database, session_id);
    session.used_ns = usedTime(database, session.session_id);
    Statement find = database.prepare(
        std::string("SELECT s.participant_id, s.protocol_sha256, s.language, s.ordinal, s.seed, s.epoch='virtual', "
                    "s.end_state='crashed', (") +
        kAgeDays +
        ") * 86400.0, s.station FROM session s "
        "JOIN segment g USING(session_id) WHERE s.session_id=?1 ORDER BY g.segment_id DESC LIMIT 1");
    find.bind(session.session_id, now_utc, session.used_ns).step();
    session.participant = find.text(0);
    session.protocol_sha256 = find.text(1);
    session.language = find.text(2);
    session.ordinal = static_cast<int>(find.integer(3));
    session.seed = static_cast<std::uint64_t>(find.integer(4));
    session.virtual_time = find.integer(5) != 0;
    session.crashed = find.integer(6) != 0;
    if (!session.virtual_time) session.age_s = find.real(7);
    session.station = find.text(8);
    find.reset();
    if (!session.virtual_time) session.latest_utc = latestUtc(database, session.session_id);
    readTrials(database, session);
    session.steps = readOrderSteps(database, session.session_id);
    readForms(database, session);
    readQuality(database, session);
    return session;
}

void reopenSession(const Database& database, const std::string& session_id) {
    keepDamageKnown(database, session_id);
    database.prepare("UPDATE session SET end_state=NULL, ended_utc=NULL WHERE session_id=?").bind(session_id).run();
}

}  // namespace passung::store
