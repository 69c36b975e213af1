#include "study/store/schema/revisions.h"

#include <array>

#include "study/store/schema/first_schema.h"
#include "study/store/schema/named_columns.h"
#include "study/store/schema/person_identity.h"
#include "study/store/schema/study_views.h"

namespace passung::store {
namespace {

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

constexpr const char* kRevision11 = R"sql(
-- By the wall clock, which goes on where session time rests: in pauses, in questionnaires. NULL: virtual time.
ALTER TABLE event ADD COLUMN t_utc TEXT;
)sql";

constexpr const char* kRevision12 = R"sql(
-- who a participant is in every copy of the study, and all that is left of them there when they are erased
ALTER TABLE participant ADD COLUMN identity TEXT NOT NULL DEFAULT '';
)sql";

constexpr const char* kRevision13 = R"sql(
-- of the pictures: drawn with the visual cue above 0. NULL: not counted yet when the attempt was made.
ALTER TABLE presentation ADD COLUMN cue_frames INTEGER CHECK(cue_frames BETWEEN 0 AND frames);
)sql";

constexpr const char* kRevision14 = R"sql(
-- What of the condition's feedback reached the participant: acknowledged, drawn, played, or handed to the senses of a
-- simulated one. Ticks and pictures in which it stood above nothing.
CREATE TABLE delivery(
    attempt_id INTEGER PRIMARY KEY REFERENCES attempt ON DELETE CASCADE,
    force_ticks INTEGER NOT NULL CHECK(force_ticks >= 0),
    visual_frames INTEGER NOT NULL CHECK(visual_frames >= 0),
    vibrotactile_ticks INTEGER NOT NULL CHECK(vibrotactile_ticks >= 0),
    audio_ticks INTEGER NOT NULL CHECK(audio_ticks >= 0),
    masking_ticks INTEGER NOT NULL CHECK(masking_ticks >= 0)) STRICT;
)sql";

constexpr const char* kRevision15 = R"sql(
-- Which arithmetic a recording's ticks followed (core/tick/numerics.h). NULL: from before there was a number, counts as
-- 0.
ALTER TABLE stream ADD COLUMN numerics INTEGER;
-- SHA-256 of what the run wrote, by unit of a session, whatever numbers its rows have (value_hash.h); '' is over all
-- units. Sessions of older programs have none.
CREATE TABLE session_hash(
    session_id TEXT NOT NULL REFERENCES session ON DELETE CASCADE,
    unit TEXT NOT NULL,
    sha256 TEXT NOT NULL,
    PRIMARY KEY(session_id, unit)) STRICT, WITHOUT ROWID;
-- What people changed since: a row of the session before and after. No sha256 before: the row is new.
CREATE TABLE later_change(
    session_id TEXT NOT NULL REFERENCES session ON DELETE CASCADE,
    after_sha256 TEXT NOT NULL,
    before_sha256 TEXT,
    PRIMARY KEY(session_id, after_sha256)) STRICT, WITHOUT ROWID;
-- The same of rows that belong to no session; those of a person go with them.
CREATE TABLE row_hash(
    table_name TEXT NOT NULL,
    row_key TEXT NOT NULL,
    participant_id TEXT REFERENCES participant ON DELETE CASCADE,
    sha256 TEXT NOT NULL,
    PRIMARY KEY(table_name, row_key)) STRICT, WITHOUT ROWID;
)sql";

constexpr const char* kRevision16 = R"sql(
-- what of the ticks' computing time their thread spent on a processor; NULL: not measured
ALTER TABLE timing ADD COLUMN processor_mean_us REAL;
ALTER TABLE timing ADD COLUMN processor_p99_us REAL;
ALTER TABLE timing ADD COLUMN processor_p999_us REAL;
ALTER TABLE timing ADD COLUMN processor_max_us REAL;
)sql";

constexpr const char* kRevision17 = R"sql(
-- how deep the parts truly reached into each other, as shown, at ticks that were judged after the trial
CREATE TABLE exact_overlap(
    attempt_id INTEGER NOT NULL REFERENCES attempt ON DELETE CASCADE,
    tick INTEGER NOT NULL CHECK(tick >= 0),
    every_20th INTEGER NOT NULL,
    largest_depth INTEGER NOT NULL,
    largest_force INTEGER NOT NULL,
    overlap_m REAL NOT NULL CHECK(overlap_m >= 0),
    bound_m REAL NOT NULL CHECK(bound_m >= overlap_m),
    PRIMARY KEY(attempt_id, tick)) STRICT, WITHOUT ROWID;
)sql";

constexpr const char* kRevision18 = R"sql(
ALTER TABLE contact_energy ADD COLUMN hand TEXT;
)sql";

constexpr const char* kRevision19 = R"sql(
-- Streams "navigation", "navigation_hand_2" and so on hold what clutch, second scale and drift did in each tick: in
-- segments with a scene that has one of them.
)sql";

constexpr const char* kRevision20 = R"sql(
-- Streams "bodies", "bodies_hand_2" and so on tell which part a hand holds in each tick, and the steps that are done: in
-- segments with a scene whose parts are picked up.
-- What became of each step of an attempt at an assembly
CREATE TABLE assembly_step(
    attempt_id INTEGER NOT NULL REFERENCES attempt ON DELETE CASCADE,
    step INTEGER NOT NULL CHECK(step >= 0),
    name TEXT NOT NULL,
    part TEXT NOT NULL,
    picked_ms INTEGER,
    done_ms INTEGER,
    place INTEGER NOT NULL,
    picks INTEGER NOT NULL,
    drops INTEGER NOT NULL,
    order_errors INTEGER NOT NULL,
    undos INTEGER NOT NULL,
    hands INTEGER NOT NULL,
    held_ms INTEGER NOT NULL,
    path_m REAL NOT NULL,
    peak_force_N REAL NOT NULL,
    position_error_m REAL NOT NULL,
    angle_error_rad REAL NOT NULL,
    PRIMARY KEY(attempt_id, step)) STRICT, WITHOUT ROWID;
)sql";

constexpr const char* kRevision21 = R"sql(
-- Streams "effects", "effects_hand_2" and so on hold what each effect added to the wrench in each tick: in segments with
-- a scene that asks for it.
)sql";

constexpr const char* kRevision22 = R"sql(
-- Chunks of "effects" have six columns more, of snap.
)sql";

constexpr const char* kRevision23 = R"sql(
-- Chunks of "effects" have twelve columns more, of inertia and of keeping apart.
ALTER TABLE assembly_step ADD COLUMN free_path_m REAL CHECK(free_path_m > 0);
ALTER TABLE assembly_step ADD COLUMN hints INTEGER NOT NULL DEFAULT 0 CHECK(hints >= 0);
)sql";

constexpr const char* kRevision24 = R"sql(
-- Views v_trials, v_cells, v_scores, v_events, v_thresholds and column_doc, made of the study's factors and measures
-- (study_views.h). Samples are packed by columns-v3 of a stream's encoding.
)sql";

const std::array kRevisions = {
    Revision{1, "Protocols, participants, sessions, trials, samples, timing and questionnaires", kFirstSchema, 1},
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
    Revision{11, "When by the wall clock each event happened", kRevision11, 8},
    Revision{12, "An identity of every participant beside the code", kRevision12, 8,
             [](const Database& database) { giveIdentities(database, "main"); }},
    Revision{13, "Pictures of each attempt that were drawn with the visual cue", kRevision13, 8},
    Revision{14, "What of each attempt's feedback was delivered", kRevision14, 8},
    Revision{15, "Hashes of what was written, the number of a recording's arithmetic", kRevision15, 8},
    // Chunks of samples and of times have a column more, which a reader from before takes for damage.
    Revision{16, "The gap that was proven at each tick, the processor's time beside the wall clock's", kRevision16, 16},
    Revision{17, "True overlaps at judged ticks of each attempt", kRevision17, 16},
    // A reader from before takes the ticks of further hands for times, and those for damage.
    Revision{18, "Ticks and energy of further hands", kRevision18, 18},
    // A reader from before takes these streams for times, and those for damage.
    Revision{19, "Clutch, scale and drift of each tick", kRevision19, 19},
    // As for the streams of navigation.
    Revision{20, "Parts in hands, steps of assemblies", kRevision20, 20},
    // Likewise.
    Revision{21, "What each effect added to the wrench", kRevision21, 21},
    // A reader from before takes the longer chunks for damage.
    Revision{22, "What snap added to the wrench", kRevision22, 22},
    // A reader from before takes the longer chunks for damage.
    Revision{23, "What inertia and keeping apart added to the wrench; free paths of an assembly's steps, and hints",
             kRevision23, 23},
    // A reader from before cannot unpack the samples.
    Revision{24, "Views for people, samples in half the room", kRevision24, 24, makeStudyViews},
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
        if (revision.fill != nullptr) revision.fill(database);
        insertRow(database, "schema_revision", Named{"revision", revision.number}, Named{"sentence", revision.sentence},
                  Named{"oldest_reader", revision.oldest_reader}, Named{"applied_utc", applied_utc});
    }
    transaction.commit();
}

}  // namespace passung::store
