#include "study/store/schema/first_schema.h"

namespace passung::store {

// Times: t_ns, start_ns … are monotonic, counted from the segment's zero. NULL means "not measured".
const char* const kFirstSchema = R"sql(
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

}  // namespace passung::store
