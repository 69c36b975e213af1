#include "analysis/report/course_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/export/gzip.h"
#include "study/measures/period_clock.h"
#include "study/measures/tick_facts.h"
#include "study/store/samples/sample_codec.h"

namespace passung::report {
namespace {

using store::AttemptRow;

constexpr std::int64_t kStep = 25;       // [ms], of a trial that is short enough
constexpr std::int64_t kMostRows = 400;  // of a trial, beside those where contact begins
constexpr std::int64_t kMostRowsOfAll = 200'000;
constexpr std::int64_t kMostBeginnings = 100;  // of a trial

std::vector<exporter::Column> columnsOfCourse() {
    const auto recorded = [](const std::string& name) {
        const auto& channels = store::tickChannels();
        const auto channel =
            std::find_if(channels.begin(), channels.end(), [&](const store::Channel& c) { return c.name == name; });
        return exporter::describe(name, channel->label, "number", {.unit = channel->unit});
    };
    std::vector<exporter::Column> columns = {
        exporter::describe("participant_id", "Code of the participant", "text", {}),
        exporter::describe("session", "Number of the participant's session, from 1", "integer", {}),
        exporter::describe("trial_index", "Number of the trial in the session, from 0", "integer", {}),
        exporter::describe("attempt_no", "Attempt at this trial, from 1", "integer", {}),
        exporter::describe("t_s", "Time since the start of the trial", "number", {.unit = "s"}),
        exporter::describe("contact_begins", "1 at the first tick of a contact", "0/1",
                           {.levels = {"0", "1"},
                            .formula = "a contact tick, see approach_time_s of trials.csv, after one that is none"})};
    for (const char* name :
         {"proxy_x_m", "proxy_y_m", "proxy_z_m", "force_x_N", "force_y_N", "force_z_N", "hand_depth_m"})
        columns.push_back(recorded(name));
    return columns;
}

void addRow(std::string& text, const std::string& begin, std::int64_t period, bool begins, const TickRecord& record) {
    text += fmt::format("{},{},{}", begin, static_cast<double>(period) / 1000.0, begins ? 1 : 0);
    for (const auto& vector : {record.proxy_position_m, record.force_N})
        for (const float value : vector) text += fmt::format(",{}", value);
    text += fmt::format(",{}\n", record.hand_depth_m);
}

/// Rows of one trial, no more than `most` of them by the step.
void addTrial(std::string& text, const AttemptRow& attempt, std::span<const TickRecord> records, std::int64_t most) {
    std::string begin;
    exporter::appendField(begin, attempt.participant_id);
    begin += fmt::format(",{},{},{}", attempt.session_ordinal, attempt.trial_index, attempt.attempt_no);
    const std::int64_t length = *attempt.end_tick - *attempt.start_tick;
    const std::int64_t step = std::max(kStep, (length + most - 1) / most);
    measures::PeriodClock clock(*attempt.start_tick);
    std::int64_t next = 0, beginnings = 0;  // next: period of the next row
    bool touched = false;
    for (const TickRecord& record : records) {
        if (record.tick < *attempt.start_tick || record.tick >= *attempt.end_tick) continue;
        const std::int64_t period = clock.at(record);
        const bool touches = measures::isContact(record);
        const bool begins = touches && !touched && beginnings < kMostBeginnings;
        touched = touches;
        if (begins) ++beginnings;
        if (!begins && period < next) continue;
        addRow(text, begin, period, begins, record);
        if (period >= next) next = period + step;
    }
}

}  // namespace

Result<exporter::ExportedFile> courseFile(const store::StoreReader& reader, const exporter::StudyData& study) {
    const auto counted = exporter::countedSessions(study);
    std::vector<const AttemptRow*> trials;
    for (const AttemptRow& attempt : study.attempts)
        if (exporter::countsInMeans(study, attempt) && counted.count(attempt.session_id) != 0 && attempt.start_tick &&
            attempt.end_tick)
            trials.push_back(&attempt);
    if (trials.empty()) return exporter::ExportedFile{};
    exporter::ExportedFile file{
        .path = "courses.csv.gz",
        .bytes = {},
        .about =
            "Some recorded ticks of each trial that counts, for the pictures of the report: one row each 25 ms or, "
            "of "
            "long trials and large studies, more rarely, and one where contact begins. All ticks: `passung "
            "export`.",
        .columns = columnsOfCourse()};
    std::string text = exporter::toCsv(exporter::Table{{}, {}, file.columns, {}});
    const auto most =
        std::clamp(kMostRowsOfAll / static_cast<std::int64_t>(trials.size()), std::int64_t{40}, kMostRows);
    for (const AttemptRow* trial : trials) {
        const auto records = reader.records(trial->attempt_id);
        if (!records) return records.errors();
        addTrial(text, *trial, *records, most);
    }
    file.bytes = exporter::gzip(text);
    return file;
}

}  // namespace passung::report
