#pragma once

#include <string>
#include <vector>

#include "study/store/schema/session_tables.h"
#include "study/store/schema/sqlite.h"
#include "tests/study/store/fake_questionnaire.h"

/// A study with every kind of row that a session writes, and ways to damage it, for tests of what happens then.
namespace passung::fake {

inline constexpr std::int64_t kSecond = 1'000'000'000;

/// A whole session of two trials with samples, events, a form and a note.
inline void performAsking(const std::string& path, const std::string& code,
                          const plan::StudyPlan& plan = makeAskingPlan()) {
    const auto store = openStore(path);
    const auto writer = beginAskingSession(*store, plan, code, 2);
    for (int trial = 0; trial < 2; ++trial) require(writeAttempt(*writer, trial, 1200));
    require(storeForm(*writer, plan, {0, 0, {}, 2}, {6, 3, 7, std::nullopt, 2, 2, 4, 5}, 3 * kSecond));
    require(writer->addNote("e", "the lamp flickered", 4 * kSecond));
    require(writer->finishSession(true, 5 * kSecond));
}

/// A change that no program made, and what is to be said of it.
struct Planted {
    const char* sql;
    const char* line;
};

/// One of every kind of value, in a file with S001 and S002.
inline const std::vector<Planted> kPlanted = {
    {"UPDATE attempt_measure SET value_num=value_num+1e-15 WHERE attempt_id=2 AND measure='peak_force_N'",
     "S001, session 1, trial 2, attempt 1, attempt_measure: is not as the run wrote it"},
    {"UPDATE attempt SET outcome='failure' WHERE attempt_id=1", "S001, session 1, trial 1, attempt 1"},
    {"UPDATE attempt SET attempt_no=3 WHERE attempt_id=1", "S001, session 1, trial 1, attempt 1"},
    {"UPDATE item_response SET value_num=4 WHERE run_id=2 AND item='located'", "S002, session 1, form 1"},
    {"UPDATE item_response SET skipped=0 WHERE run_id=1 AND item='located'", "S001, session 1, form 1"},
    {"UPDATE questionnaire_run SET moment='session_end' WHERE run_id=1", "S001, session 1, form 1"},
    {"DELETE FROM score WHERE run_id=1 AND scale='overall'", "S001, session 1, form 1, score"},
    {"UPDATE event SET payload_json='{}}' WHERE attempt_id=3", "S002, session 1, trial 1, attempt 1, event"},
    {"DELETE FROM event WHERE attempt_id=3", "S002, session 1, trial 1, attempt 1, event"},
    {"UPDATE event SET t_ns=t_ns+1 WHERE attempt_id IS NULL", "S001, session 1, segment 1, event"},
    {"UPDATE note SET text='the lamp flickeret' WHERE note_id=1", "S001, session 1, note"},
    {"UPDATE session SET ended_utc='2000-01-01T00:00:07.000Z' WHERE participant_id='S001'", "S001, session 1, session"},
    {"UPDATE trial_plan SET block='z' WHERE trial_id=1", "S001, session 1, plan"},
    {"UPDATE trial_plan SET trial_index=7 WHERE trial_id=1", "S001, session 1, plan"},
    {"UPDATE segment SET app_version='9' WHERE segment_id=2", "S002, session 1, segment 1"},
    {"UPDATE stream SET numerics=3 WHERE stream_id=2", "S002, session 1, segment 1, stream"},
    {"UPDATE sample_chunk SET t0_ns=t0_ns+1 WHERE chunk_no=3 AND stream_id=1",
     "S001, session 1, trial 2, attempt 1, samples"},
    {"UPDATE sample_chunk SET data=zeroblob(length(data)) WHERE chunk_no=0 AND stream_id=1",
     "S001, session 1, trial 1, attempt 1, samples: chunk of samples from tick 0: checksum"},
    {"UPDATE sample_chunk SET crc32=crc32+1 WHERE chunk_no=0 AND stream_id=1",
     "S001, session 1, trial 1, attempt 1, samples: chunk of samples from tick 0: checksum"},
    {"DELETE FROM sample_chunk WHERE chunk_no=1 AND stream_id=1", "S001, session 1, trial 1, attempt 1, samples"},
    {"UPDATE participant SET status_reason='?' WHERE participant_id='S002'", "participant S002"},
    {"UPDATE condition SET levels_json='{}' WHERE position=1", "condition"},
    {"UPDATE condition SET condition='god/0.4' WHERE position=2", "condition"},
    {"UPDATE protocol_version SET source_text=source_text || ' '", "is not the text of that SHA-256"},
    {"UPDATE protocol_version SET expanded_json='{'", "protocol_version"},
    {"UPDATE measure SET formula='?' WHERE measure='peak_force_N'", "measure peak_force_N"},
    {"UPDATE design_slot SET state='burned' WHERE participant_id='S001'", "design_slot"},
    {"UPDATE session_hash SET sha256='00' WHERE unit='plan'", "the list of its hashes is damaged"},
    {"UPDATE row_hash SET sha256='00' WHERE row_key='S001'", "participant S001"},
    {"UPDATE row_hash SET row_key='S0p1' WHERE row_key='S001'", "participant S0p1: is gone"},
    {"UPDATE row_hash SET table_name='participanu' WHERE row_key='S001'", "participanu S001: is gone"},
    {"UPDATE trial_plan SET session_id='?' WHERE trial_id=1", "a row of trial_plan belongs to no row of session"},
    {"UPDATE attempt SET trial_id=77 WHERE attempt_id=1", "a row of attempt belongs to no row of trial_plan"},
    {"UPDATE attempt SET segment_id=77 WHERE attempt_id=3", "a row of attempt belongs to no row of segment"},
    {"UPDATE attempt_measure SET attempt_id=77 WHERE attempt_id=2 AND measure='peak_force_N'",
     "a row of attempt_measure belongs to no row of attempt"},
    {"UPDATE item_response SET run_id=77 WHERE run_id=1 AND item='located'",
     "a row of item_response belongs to no row of questionnaire_run"},
    {"UPDATE sample_chunk SET stream_id=77 WHERE chunk_no=1 AND stream_id=1",
     "a row of sample_chunk belongs to no row of stream"},
    {"UPDATE session SET participant_id='S003' WHERE participant_id='S002'",
     "a row of session belongs to no row of participant"},
};

/// Every value of the file, a line a row.
inline std::vector<std::string> dump(const std::string& path) {
    const store::Database database(path, store::OpenMode::ReadWrite);
    std::vector<std::string> lines;
    for (const std::string& name : store::tableNames(database)) {
        std::string columns;
        for (const store::TableColumn& column : store::describeTable(database, name).columns)
            columns += (columns.empty() ? "quote(" : " || ', ' || quote(") + column.name + ")";
        store::Statement rows = database.prepare("SELECT " + columns + " AS line FROM " + name + " ORDER BY line");
        while (rows.step()) lines.push_back(name + ": " + rows.text(0));
    }
    return lines;
}

}  // namespace passung::fake
