#include "study/store/revisions.h"

#include <array>

namespace passung::store {
namespace {

// Times: t_ns, start_ns … are monotonic, counted from the segment's zero. NULL means "not measured".
constexpr const char* kRevision1 = R"sql(
CREATE TABLE schema_revision(
    revision INTEGER PRIMARY KEY,
    sentence TEXT NOT NULL,
    oldest_reader INTEGER NOT NULL,
    applied_utc TEXT NOT NULL) STRICT;

-- what was planned
CREATE TABLE protocol_version(
    protocol_sha256 TEXT PRIMARY KEY,
    name TEXT NOT NULL,
    version TEXT NOT NULL,
    source_text TEXT NOT NULL,
    expanded_json TEXT NOT NULL,
    schema_version INTEGER NOT NULL,
    app_version TEXT NOT NULL,
    imported_utc TEXT NOT NULL,
    title TEXT NOT NULL,
    sequences INTEGER NOT NULL CHECK(sequences > 0)) STRICT;
CREATE TABLE mesh_file(
    protocol_sha256 TEXT NOT NULL REFERENCES protocol_version,
    mesh TEXT NOT NULL,
    sha256 TEXT NOT NULL,
    bytes INTEGER NOT NULL,
    PRIMARY KEY(protocol_sha256, mesh)) STRICT, WITHOUT ROWID;
CREATE TABLE factor(
    protocol_sha256 TEXT NOT NULL REFERENCES protocol_version,
    factor TEXT NOT NULL,
    kind TEXT NOT NULL CHECK(kind IN('within','between','nuisance')),
    data_type TEXT NOT NULL,
    unit TEXT,
    label TEXT,
    position INTEGER NOT NULL,
    levels_json TEXT NOT NULL CHECK(json_valid(levels_json)),
    PRIMARY KEY(protocol_sha256, factor)) STRICT;
CREATE TABLE condition(
    condition_id INTEGER PRIMARY KEY,
    protocol_sha256 TEXT NOT NULL REFERENCES protocol_version,
    condition TEXT NOT NULL,
    levels_json TEXT NOT NULL CHECK(json_valid(levels_json)),
    position INTEGER NOT NULL,
    UNIQUE(protocol_sha256, condition)) STRICT;
CREATE TABLE measure(
    measure TEXT PRIMARY KEY,
    label TEXT NOT NULL,
    unit TEXT,
    data_type TEXT NOT NULL,
    formula TEXT NOT NULL,
    formula_version INTEGER NOT NULL,
    position INTEGER NOT NULL) STRICT;
CREATE TABLE protocol_measure(
    protocol_sha256 TEXT NOT NULL REFERENCES protocol_version,
    measure TEXT NOT NULL REFERENCES measure,
    PRIMARY KEY(protocol_sha256, measure)) STRICT, WITHOUT ROWID;

-- who takes part
CREATE TABLE participant(
    participant_id TEXT PRIMARY KEY CHECK(participant_id GLOB '[A-Z]*[0-9]'),
    kind TEXT NOT NULL CHECK(kind IN('real','pilot','simulated')),
    status TEXT NOT NULL CHECK(status IN('enrolled','active','complete','excluded','withdrawn')),
    status_reason TEXT,
    created_utc TEXT NOT NULL) STRICT;
CREATE TABLE design_slot(
    slot_id INTEGER PRIMARY KEY,
    protocol_sha256 TEXT NOT NULL REFERENCES protocol_version,
    between_group TEXT NOT NULL,
    sequence_index INTEGER NOT NULL,
    replicate INTEGER NOT NULL,
    station TEXT,
    state TEXT NOT NULL CHECK(state IN('free','assigned','complete','burned')),
    participant_id TEXT UNIQUE REFERENCES participant ON DELETE SET NULL,
    kind TEXT NOT NULL CHECK(kind IN('real','pilot','simulated')),
    UNIQUE(protocol_sha256, kind, between_group, sequence_index, replicate)) STRICT;
CREATE TABLE consent(
    consent_id INTEGER PRIMARY KEY,
    participant_id TEXT NOT NULL REFERENCES participant ON DELETE CASCADE,
    text_sha256 TEXT NOT NULL,
    language TEXT NOT NULL,
    clause TEXT NOT NULL,
    decision TEXT NOT NULL CHECK(decision IN('yes','no','withdrawn')),
    decided_utc TEXT NOT NULL) STRICT;

-- what happened
CREATE TABLE session(
    session_id TEXT PRIMARY KEY,
    participant_id TEXT NOT NULL REFERENCES participant ON DELETE CASCADE,
    protocol_sha256 TEXT NOT NULL REFERENCES protocol_version,
    ordinal INTEGER NOT NULL,
    station TEXT NOT NULL,
    experimenter TEXT,
    language TEXT NOT NULL,
    seed INTEGER NOT NULL,
    rng TEXT NOT NULL,
    started_utc TEXT NOT NULL,
    ended_utc TEXT,
    end_state TEXT CHECK(end_state IN('complete','aborted','crashed','withdrawn')),
    epoch TEXT NOT NULL CHECK(epoch IN('virtual','wall')),
    UNIQUE(participant_id, ordinal)) STRICT;
CREATE TABLE segment(
    segment_id INTEGER PRIMARY KEY,
    session_id TEXT NOT NULL REFERENCES session ON DELETE CASCADE,
    app_version TEXT NOT NULL,
    host TEXT,
    device_json TEXT NOT NULL CHECK(json_valid(device_json)),
    mono_zero_ns INTEGER NOT NULL,
    utc_zero TEXT NOT NULL,
    started_utc TEXT NOT NULL,
    closed_clean INTEGER NOT NULL DEFAULT 0) STRICT;
CREATE TABLE trial_plan(
    trial_id INTEGER PRIMARY KEY,
    session_id TEXT NOT NULL REFERENCES session ON DELETE CASCADE,
    trial_index INTEGER NOT NULL,
    block_index INTEGER NOT NULL,
    block TEXT NOT NULL,
    trial_in_block INTEGER NOT NULL,
    phase TEXT NOT NULL CHECK(phase IN('practice','main','catch','adaptive')),
    condition_id INTEGER NOT NULL REFERENCES condition,
    repetition INTEGER NOT NULL,
    UNIQUE(session_id, trial_index)) STRICT;
CREATE TABLE attempt(
    attempt_id INTEGER PRIMARY KEY,
    trial_id INTEGER NOT NULL REFERENCES trial_plan ON DELETE CASCADE,
    attempt_no INTEGER NOT NULL,
    segment_id INTEGER NOT NULL REFERENCES segment ON DELETE CASCADE,
    start_ns INTEGER NOT NULL,
    end_ns INTEGER,
    outcome TEXT NOT NULL DEFAULT 'running'
        CHECK(outcome IN('running','success','failure','timeout','aborted','crashed')),
    valid INTEGER NOT NULL DEFAULT 1,
    invalid_reason TEXT,
    params_json TEXT NOT NULL CHECK(json_valid(params_json)),
    stages_json TEXT NOT NULL CHECK(json_valid(stages_json)),
    seed INTEGER NOT NULL,
    state_hash TEXT,
    timing_measured INTEGER,
    UNIQUE(trial_id, attempt_no)) STRICT;
CREATE TABLE attempt_measure(
    attempt_id INTEGER NOT NULL REFERENCES attempt ON DELETE CASCADE,
    measure TEXT NOT NULL REFERENCES measure,
    value_num REAL,
    value_text TEXT,
    PRIMARY KEY(attempt_id, measure)) STRICT, WITHOUT ROWID;
CREATE TABLE event(
    event_id INTEGER PRIMARY KEY,
    segment_id INTEGER NOT NULL REFERENCES segment ON DELETE CASCADE,
    attempt_id INTEGER REFERENCES attempt ON DELETE CASCADE,
    t_ns INTEGER NOT NULL,
    source TEXT NOT NULL,
    event TEXT NOT NULL,
    payload_json TEXT) STRICT;
CREATE TABLE stream(
    stream_id INTEGER PRIMARY KEY,
    segment_id INTEGER NOT NULL REFERENCES segment ON DELETE CASCADE,
    stream TEXT NOT NULL,
    nominal_hz REAL NOT NULL,
    channels_json TEXT NOT NULL CHECK(json_valid(channels_json)),
    encoding TEXT NOT NULL) STRICT;
CREATE TABLE sample_chunk(
    stream_id INTEGER NOT NULL REFERENCES stream ON DELETE CASCADE,
    chunk_no INTEGER NOT NULL,
    attempt_id INTEGER REFERENCES attempt ON DELETE CASCADE,
    first_tick INTEGER NOT NULL,
    n INTEGER NOT NULL,
    t0_ns INTEGER NOT NULL,
    crc32 INTEGER NOT NULL,
    data BLOB NOT NULL,
    PRIMARY KEY(stream_id, chunk_no)) STRICT;
CREATE TABLE timing(
    attempt_id INTEGER PRIMARY KEY REFERENCES attempt ON DELETE CASCADE,
    loop TEXT NOT NULL,
    ticks INTEGER NOT NULL,
    mean_us REAL,
    sd_us REAL,
    p99_us REAL,
    p999_us REAL,
    max_us REAL,
    overruns INTEGER NOT NULL,
    dropped_samples INTEGER NOT NULL,
    hist_json TEXT) STRICT;

-- what was asked
CREATE TABLE questionnaire(
    questionnaire_sha256 TEXT PRIMARY KEY,
    key TEXT NOT NULL,
    version TEXT NOT NULL,
    language TEXT NOT NULL,
    licence TEXT NOT NULL,
    definition_json TEXT NOT NULL) STRICT;
CREATE TABLE questionnaire_run(
    run_id INTEGER PRIMARY KEY,
    session_id TEXT NOT NULL REFERENCES session ON DELETE CASCADE,
    questionnaire_sha256 TEXT NOT NULL REFERENCES questionnaire,
    moment TEXT NOT NULL,
    block_index INTEGER,
    trial_id INTEGER REFERENCES trial_plan,
    condition_id INTEGER REFERENCES condition,
    started_utc TEXT NOT NULL,
    completed_utc TEXT) STRICT;
CREATE TABLE item_response(
    run_id INTEGER NOT NULL REFERENCES questionnaire_run ON DELETE CASCADE,
    item TEXT NOT NULL,
    presented_index INTEGER NOT NULL,
    value_num REAL,
    value_text TEXT,
    skipped INTEGER NOT NULL DEFAULT 0,
    rt_ms INTEGER,
    changes INTEGER NOT NULL DEFAULT 0,
    PRIMARY KEY(run_id, item)) STRICT, WITHOUT ROWID;
CREATE TABLE score(
    run_id INTEGER NOT NULL REFERENCES questionnaire_run ON DELETE CASCADE,
    scale TEXT NOT NULL,
    value REAL,
    n_items INTEGER NOT NULL,
    n_missing INTEGER NOT NULL,
    scoring_version INTEGER NOT NULL,
    PRIMARY KEY(run_id, scale)) STRICT, WITHOUT ROWID;
CREATE TABLE staircase_step(
    attempt_id INTEGER PRIMARY KEY REFERENCES attempt ON DELETE CASCADE,
    track TEXT NOT NULL,
    method TEXT NOT NULL,
    level REAL NOT NULL,
    response INTEGER,
    reversal INTEGER,
    state_json TEXT NOT NULL) STRICT;
CREATE TABLE note(
    note_id INTEGER PRIMARY KEY,
    session_id TEXT NOT NULL REFERENCES session ON DELETE CASCADE,
    t_utc TEXT NOT NULL,
    author TEXT,
    text TEXT NOT NULL) STRICT;
CREATE TABLE audit(
    audit_id INTEGER PRIMARY KEY,
    t_utc TEXT NOT NULL,
    actor TEXT NOT NULL,
    action TEXT NOT NULL,
    detail_json TEXT NOT NULL,
    prev_hash TEXT NOT NULL,
    hash TEXT NOT NULL) STRICT;

CREATE INDEX attempt_of_segment ON attempt(segment_id);
CREATE INDEX chunk_of_attempt ON sample_chunk(attempt_id);
CREATE INDEX event_of_attempt ON event(attempt_id);
CREATE INDEX event_of_segment ON event(segment_id);
CREATE INDEX stream_of_segment ON stream(segment_id);
CREATE INDEX segment_of_session ON segment(session_id);
)sql";

constexpr const char* kRevision2 = R"sql(
-- what was measured for contact.accuracy = "auto" when the protocol first ran, and what was picked
CREATE TABLE accuracy_candidate(
    protocol_sha256 TEXT NOT NULL REFERENCES protocol_version,
    candidate INTEGER NOT NULL CHECK(candidate >= 0),
    mode TEXT NOT NULL,
    tolerance_um REAL NOT NULL CHECK(tolerance_um > 0),
    spacing_mm REAL NOT NULL CHECK(spacing_mm > 0),
    budget_nodes INTEGER NOT NULL CHECK(budget_nodes >= 0),
    points INTEGER NOT NULL,
    time_median_us REAL NOT NULL,
    time_p99_us REAL NOT NULL,
    time_max_us REAL NOT NULL,
    error_mean_um REAL NOT NULL,
    error_p99_um REAL NOT NULL,
    error_max_um REAL NOT NULL,
    PRIMARY KEY(protocol_sha256, candidate)) STRICT, WITHOUT ROWID;
CREATE TABLE accuracy_pick(
    protocol_sha256 TEXT NOT NULL,
    budget_us REAL NOT NULL CHECK(budget_us > 0),
    candidate INTEGER NOT NULL,
    PRIMARY KEY(protocol_sha256, budget_us),
    FOREIGN KEY(protocol_sha256, candidate) REFERENCES accuracy_candidate) STRICT, WITHOUT ROWID;
)sql";

constexpr const char* kRevision3 = R"sql(
-- the wrench's errors beside the depth's; NULL: not measured
ALTER TABLE accuracy_candidate ADD COLUMN force_error_p99_percent REAL;
ALTER TABLE accuracy_candidate ADD COLUMN direction_error_p99_deg REAL;
ALTER TABLE accuracy_candidate ADD COLUMN torque_error_p99_percent REAL;
)sql";

constexpr const char* kRevision4 = R"sql(
-- the stable maxima of the devices when the protocol was first imported: what "max" means in it, and where they are from
CREATE TABLE stable_stiffness(
    protocol_sha256 TEXT NOT NULL REFERENCES protocol_version,
    device TEXT NOT NULL,
    stable_stiffness_N_per_m REAL NOT NULL CHECK(stable_stiffness_N_per_m >= 0),
    stable_rotational_stiffness_Nm_per_rad REAL NOT NULL CHECK(stable_rotational_stiffness_Nm_per_rad >= 0),
    origin TEXT NOT NULL,
    PRIMARY KEY(protocol_sha256, device)) STRICT, WITHOUT ROWID;
)sql";

constexpr const char* kRevision5 = R"sql(
-- what people are asked to agree to, by protocol
CREATE TABLE consent_clause(
    protocol_sha256 TEXT NOT NULL REFERENCES protocol_version,
    clause TEXT NOT NULL,
    language TEXT NOT NULL,
    text TEXT NOT NULL,
    text_sha256 TEXT NOT NULL,
    required INTEGER NOT NULL CHECK(required IN(0,1)),
    position INTEGER NOT NULL,
    PRIMARY KEY(protocol_sha256, clause, language)) STRICT, WITHOUT ROWID;
-- The chain runs over this hash, so that it still holds when erasing a participant takes a detail away.
ALTER TABLE audit ADD COLUMN detail_sha256 TEXT NOT NULL DEFAULT '';
CREATE INDEX consent_of_participant ON consent(participant_id);
)sql";

constexpr const char* kRevision6 = R"sql(
-- what the controller took in through each obstacle; NULL: what no obstacle pushed
CREATE TABLE contact_energy(
    attempt_id INTEGER NOT NULL REFERENCES attempt ON DELETE CASCADE,
    place INTEGER NOT NULL CHECK(place >= 0),
    obstacle TEXT,
    taken_in_J REAL NOT NULL,
    least_J REAL NOT NULL CHECK(least_J <= 0),
    PRIMARY KEY(attempt_id, place)) STRICT, WITHOUT ROWID;
)sql";

constexpr const char* kRevision7 = R"sql(
-- the secondary task: stimuli with their responses, and presses that answer none
CREATE TABLE secondary_response(
    attempt_id INTEGER NOT NULL REFERENCES attempt ON DELETE CASCADE,
    number INTEGER NOT NULL CHECK(number > 0),
    stimulus_ns INTEGER,
    off_ns INTEGER,
    response_ns INTEGER,
    result TEXT NOT NULL CHECK(result IN('hit','miss','false_alarm','not_scored')),
    PRIMARY KEY(attempt_id, number)) STRICT, WITHOUT ROWID;
-- pictures of the instructions
CREATE TABLE picture_file(
    protocol_sha256 TEXT NOT NULL REFERENCES protocol_version,
    picture TEXT NOT NULL,
    sha256 TEXT NOT NULL,
    bytes INTEGER NOT NULL,
    PRIMARY KEY(protocol_sha256, picture)) STRICT, WITHOUT ROWID;
)sql";

constexpr const char* kRevision8 = R"sql(
-- What staircases had a trial present, and what came of it. No program wrote the table of revision 1.
DROP TABLE staircase_step;
CREATE TABLE staircase_step(
    attempt_id INTEGER PRIMARY KEY REFERENCES attempt ON DELETE CASCADE,
    staircase TEXT NOT NULL,
    track TEXT,                       -- NULL: a catch trial
    wanted_level REAL NOT NULL,       -- by the rule
    level REAL NOT NULL,              -- presented
    condition_id INTEGER NOT NULL REFERENCES condition,  -- presented
    positive INTEGER CHECK(positive IN(0,1)),
    reversal INTEGER NOT NULL DEFAULT 0 CHECK(reversal IN(0,1)),
    estimate REAL,
    estimate_sd REAL) STRICT;
)sql";

constexpr const char* kRevision9 = R"sql(
-- what a window gave the participant: pictures, with their age when the display got them, and sound
CREATE TABLE presentation(
    attempt_id INTEGER PRIMARY KEY REFERENCES attempt ON DELETE CASCADE,
    drawn_pose TEXT NOT NULL CHECK(drawn_pose IN('proxy','device')),
    frames INTEGER NOT NULL CHECK(frames >= 0),
    frame_age_median_us REAL,
    frame_age_p99_us REAL,
    frame_age_max_us REAL,
    sound TEXT NOT NULL CHECK(sound IN('none','played','silent')),
    sound_output TEXT,
    sound_delay_us REAL) STRICT;
)sql";

constexpr const char* kRevision10 = R"sql(
-- What became of trials in the order of their session, in time: a resumed session goes on in the same order.
CREATE TABLE order_step(
    step_id INTEGER PRIMARY KEY,
    segment_id INTEGER NOT NULL REFERENCES segment ON DELETE CASCADE,
    trial_id INTEGER NOT NULL REFERENCES trial_plan ON DELETE CASCADE,
    attempt_id INTEGER UNIQUE REFERENCES attempt ON DELETE CASCADE,  -- that has ended so; NULL: between ends
    then_what TEXT NOT NULL CHECK(then_what IN('done','repeat_now','repeat_at_block_end')),
    decided_by TEXT NOT NULL CHECK(decided_by IN('protocol','experimenter','interruption'))) STRICT;
CREATE INDEX order_step_of_segment ON order_step(segment_id);
CREATE INDEX order_step_of_trial ON order_step(trial_id);
)sql";

constexpr std::array kRevisions = {
    Revision{1, "Protocols, participants, sessions, trials, samples, timing and questionnaires", kRevision1, 1},
    // A reader that does not know what was picked would replay another scene.
    Revision{2, "What accuracy = \"auto\" picked, with its calibration", kRevision2, 2},
    Revision{3, "The errors of force and torque in that calibration", kRevision3, 2},
    // As for the picks; and chunks of samples have a column more.
    Revision{4, "Stable stiffness of a protocol's devices", kRevision4, 4},
    // Samples are packed from here on: columns-v2 of a stream's encoding.
    Revision{5, "Clauses of consent, an audit whose details can be taken away, packed samples", kRevision5, 5},
    Revision{6, "Energy of each attempt by obstacle", kRevision6, 5},
    Revision{7, "Responses to a secondary task, pictures of the instructions", kRevision7, 5},
    // A reader that does not know what was presented would replay another scene.
    Revision{8, "Levels that staircases presented, with their answers", kRevision8, 8},
    Revision{9, "Pictures and sound of each attempt that a window showed", kRevision9, 8},
    Revision{10, "What became of each trial in the session's order", kRevision10, 8},
};

bool isEmpty(const Database& database) { return database.integer("SELECT count(*) FROM sqlite_master") == 0; }

}  // namespace

std::span<const Revision> revisions() { return kRevisions; }

int schemaNumber() { return kRevisions.back().number; }

int fileSchemaNumber(const Database& database) {
    return static_cast<int>(database.integer("SELECT coalesce(max(revision), 0) FROM schema_revision"));
}

SchemaState inspectSchema(const Database& database) {
    if (isEmpty(database)) return SchemaState::Empty;
    if (database.integer("PRAGMA application_id") != kApplicationId) return SchemaState::Foreign;
    const int found = fileSchemaNumber(database);
    if (found == schemaNumber()) return SchemaState::Current;
    if (found < schemaNumber()) return SchemaState::Older;
    const auto oldest_reader = database.integer("SELECT max(oldest_reader) FROM schema_revision");
    return oldest_reader <= schemaNumber() ? SchemaState::NewerCompatible : SchemaState::NewerIncompatible;
}

void upgradeSchema(const Database& database, const std::string& applied_utc) {
    const int found = isEmpty(database) ? 0 : fileSchemaNumber(database);
    Transaction transaction(database);
    database.execute("PRAGMA application_id=" + std::to_string(kApplicationId));
    for (const Revision& revision : kRevisions) {
        if (revision.number <= found) continue;
        database.execute(revision.sql);
        database.prepare("INSERT INTO schema_revision VALUES(?, ?, ?, ?)")
            .bind(revision.number, revision.sentence, revision.oldest_reader, applied_utc)
            .run();
    }
    transaction.commit();
}

}  // namespace passung::store
