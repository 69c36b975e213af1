#include "analysis/export/export.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <future>
#include <thread>

#include "analysis/export/analysis_table.h"
#include "analysis/export/assembly_step_table.h"
#include "analysis/export/cell_tables.h"
#include "analysis/export/codebook.h"
#include "analysis/export/contact_energy_table.h"
#include "analysis/export/exact_overlap_table.h"
#include "analysis/export/export_folder.h"
#include "analysis/export/gzip.h"
#include "analysis/export/missing_table.h"
#include "analysis/export/named_files.h"
#include "analysis/export/note_table.h"
#include "analysis/export/plan_file.h"
#include "analysis/export/presentation_table.h"
#include "analysis/export/psych_ds.h"
#include "analysis/export/questionnaire_tables.h"
#include "analysis/export/samples.h"
#include "analysis/export/secondary_table.h"
#include "analysis/export/session_tables.h"
#include "analysis/export/staircase_tables.h"
#include "analysis/export/study_data.h"
#include "analysis/export/trial_tables.h"
#include "study/store/samples/sample_codec.h"

namespace passung::exporter {
namespace {

constexpr const char* kSamplesPattern = "samples/*.csv.gz";

/// Makes the tables one after the other: all at once they would be larger than what they are made of.
void forEachTable(const StudyData& study, const store::StoreReader& reader, const std::function<void(Table)>& take) {
    const auto some = [&study](const auto& has) {
        return std::any_of(study.attempts.begin(), study.attempts.end(), has);
    };
    const std::vector<Cell> cells = cellsOf(study);
    take(makeTrials(study));
    take(makeCells(study, cells));
    for (Table& table : makeWide(study, cells)) take(std::move(table));
    if (!study.analyses.empty()) take(makeAnalyses(study, cells));
    take(makeEvents(reader));
    if (!study.notes.empty()) take(makeNotes(study));
    take(makeSessions(study));
    take(makeParticipants(study));
    take(makeTiming(study));
    take(makeContactEnergy(study));
    take(makeExactOverlap(study, reader));
    if (some([](const store::AttemptRow& attempt) { return !attempt.steps.empty(); })) take(makeAssemblySteps(study));
    if (some([](const store::AttemptRow& attempt) { return attempt.presentation.has_value(); }))
        take(makePresentation(study));
    if (!study.detections.empty()) take(makeSecondary(study));
    if (!study.staircase_steps.empty()) {
        take(makeStaircase(study));
        take(makeThresholds(study));
    }
    if (!study.questionnaires.empty()) {
        take(makeQuestionnaireItems(study));
        take(makeQuestionnaireScores(study));
        take(makeScoresWide(study));
        take(makeReliability(study));
    }
    if (!study.definitions.empty()) take(makeQuestionnaireKeys(study));
    take(makeFiles(study));
    if (!study.accuracy.empty()) take(makeAccuracy(study));
}

/// A cell without any text is a missing value like others.
void markMissing(TableRow& row) {
    for (std::string& text : row)
        if (text.empty()) text = kMissing;
}

std::string readmeText(const StudyData& study, const std::vector<Table>& tables, const std::vector<ExportedFile>& more,
                       bool samples) {
    std::string text = "# Export of a Passung study\n\n";
    for (const store::ProtocolRow& protocol : study.protocols) {
        text += "- " + (protocol.title.empty() ? protocol.name : protocol.title) + " (" + protocol.name + ", version " +
                protocol.version + "): `protocol/" + protocol.sha256 + ".toml`\n";
    }
    text +=
        "\nAll tables are CSV: UTF-8, comma, quotes as in RFC 4180, a header row, `NA` for a missing value. Numbers "
        "have "
        "a decimal point and as many digits as are needed to read back the same value. Units are in the column names "
        "and in `codebook.csv`, which describes every column of every file (`codebook.json`: the same for "
        "programs).\n\n"
        "**Rows of simulated participants** have `kind` = `simulated`. They show that software and analysis work, "
        "never how people behave: keep them apart.\n\n| file | holds |\n| --- | --- |\n";
    for (const Table& table : tables) {
        if (table.file == kSamplesPattern && !samples) continue;
        text += "| `" + table.file + "` | " + table.about + " |\n";
    }
    for (const ExportedFile& file : more)
        if (file.columns.empty()) text += "| `" + file.path + "` | " + file.about + " |\n";
    text +=
        "| `plan.json` | The plans as they ran: every condition, block and questionnaire with all that the protocol "
        "leaves to a default. |\n"
        "| `protocol/` | The protocols, byte for byte, with the files that they include in place; the name is the "
        "SHA-256 "
        "of the text. `files.csv` lists what else they name: questionnaires are here, of meshes and pictures the hash. "
        "|\n"
        "| `SHA256SUMS` | For `sha256sum -c SHA256SUMS`. |\n\n"
        "Read in R: `trials <- read.csv(\"trials.csv\")`; in Python: `trials = pandas.read_csv(\"trials.csv\")`. "
        "Analyse the rows with `counted` = 1; `not_counted_because` says of all others why. `cells_long.csv` has a row "
        "for each participant, session, block and condition, a wide table one for each participant and session: "
        "`wide_MEASURE.csv`, or `wide_MEASURE_BLOCK.csv` where the study has several main blocks. They count what "
        "ended "
        "in success, failure or timeout, and of each participant every complete session per protocol, else the "
        "latest (`counted` = 1 in `sessions.csv`).\n\n"
        "A time-out is no missing value: `time_s` is the time to success or to the end, `finished` says which, and the "
        "cells hold its restricted mean, which keeps everybody.";
    if (!study.analyses.empty())
        text +=
            " `analyses.csv` lists the analyses that the protocol plans: file, column, a call of R, and how many "
            "participants it keeps.";
    return text + "\n";
}

/// Writes files until the first error.
class Writer {
public:
    explicit Writer(ExportFolder& folder) : folder_(folder) {}

    void write(const std::string& path, std::string_view bytes) {
        if (!failed()) keep(folder_.write(path, bytes));
    }
    void write(const std::string& path, const ExportFolder::Pieces& pieces) {
        if (!failed()) keep(folder_.writePieces(path, pieces));
    }
    void fail(const Errors& errors) { errors_ = errors; }
    bool failed() const { return !errors_.empty(); }
    const Errors& errors() const { return errors_; }
    std::size_t files() const { return files_; }

private:
    void keep(const Result<Done>& done) {
        if (!done) errors_ = done.errors();
        ++files_;
    }

    ExportFolder& folder_;
    Errors errors_;
    std::size_t files_ = 0;
};

/// Reads and writes in order; packing, which takes nearly all of the time, runs on all processors.
void writeSamples(const store::StoreReader& reader, const StudyData& study, const ExportOptions& options,
                  Writer& writer) {
    struct Packing {
        std::string file;
        std::future<std::string> bytes;
    };
    const std::size_t at_once = std::max(1u, std::thread::hardware_concurrency());
    std::deque<Packing> packings;
    const auto writeOldest = [&] {
        try {
            writer.write(packings.front().file, packings.front().bytes.get());
        } catch (const std::exception& error) {
            writer.fail({Error{.message = error.what(), .file = packings.front().file, .key = {}, .value = {}}});
        }
        packings.pop_front();
    };
    const auto packHand = [&](const store::AttemptRow& attempt, std::size_t hand) {
        auto records = reader.records(attempt.attempt_id, hand);
        if (!records) writer.fail(records.errors());
        if (!records || records->empty()) return;
        if (packings.size() == at_once) writeOldest();
        // What is commanded beside the force goes to the first hand.
        packings.push_back(
            {samplesFile(attempt, hand),
             std::async(std::launch::async, [ticks = *std::move(records),
                                             signals = hand == 0 ? sampleSignals(study, attempt) : SampleSignals{}] {
                 return gzip(samplesCsv(ticks, signals));
             })});
    };
    for (std::size_t i = 0; i < study.attempts.size() && !writer.failed(); ++i) {
        for (std::size_t hand = 0; hand < store::kMostTickStreams && !writer.failed(); ++hand)
            packHand(study.attempts[i], hand);
        if (writer.failed()) break;
        if (options.cancelled && options.cancelled()) writer.fail({Error{.message = "the export was cancelled"}});
        if (options.progress) {
            options.progress(static_cast<double>(i + 1) / static_cast<double>(study.attempts.size()));
        }
    }
    while (!packings.empty()) writeOldest();
}

}  // namespace

Result<ExportReport> exportAll(const store::StoreReader& reader, const std::string& out_dir,
                               const ExportOptions& options) {
    const auto study = readStudy(reader);
    if (!study) return study.errors();
    std::vector<std::string> names;
    for (const store::ProtocolRow& protocol : study->protocols) names.push_back(protocol.name);
    auto folder = ExportFolder::begin(out_dir, std::move(names), options.group);
    if (!folder) return folder.errors();

    Writer writer(*folder);
    std::vector<Table> tables;  // without their rows
    std::set<std::string> names_taken;
    std::optional<Anonymiser> anonymiser;
    if (options.anonymity) anonymiser.emplace(*options.anonymity);
    const auto write = [&](Table table) {
        if (options.psych_ds) table.file = psychDsFile(*study, table, names_taken);
        auto hidden = anonymiser ? std::optional(anonymiser->begin(table)) : std::nullopt;
        writer.write(table.file, [&](const TakeText& take) {
            return writeCsv(
                table,
                [&hidden](TableRow& row) {
                    markMissing(row);
                    if (hidden) hidden->change(row);
                },
                take);
        });
        if (hidden) hidden->end();
        table.rows = {};
        table.more = {};
        tables.push_back(std::move(table));
    };
    forEachTable(*study, reader, write);
    if (!reader.damages().empty()) write(makeMissing(reader.damages()));
    if (anonymiser) {
        if (const auto unused = anonymiser->unusedBands(); !unused.empty())
            return Error{.message = "is no item that somebody was asked", .key = "--band", .value = unused.front()};
        write(anonymiser->account());
    }
    if (options.psych_ds) writer.write("dataset_description.json", psychDsDescription(*study, tables));
    if (options.samples) {
        tables.push_back({kSamplesPattern,
                          "One file per attempt, one row per recorded tick (1 kHz): "
                          "`<participant>_<session>_t<trial_index>_a<attempt_no>.csv.gz`.",
                          sampleColumns(study->extras),
                          {}});
    }
    const auto made = options.more_files ? options.more_files(*study) : Result(std::vector<ExportedFile>{});
    if (!made) return made.errors();
    const std::vector<ExportedFile>& more = *made;
    for (const ExportedFile& file : more)
        if (!file.columns.empty()) tables.push_back({file.path, file.about, file.columns, {}});
    for (const ExportedFile& file : namedFiles(*study)) writer.write(file.path, file.bytes);
    writer.write("plan.json", planJson(*study));
    tables.push_back(makeCodebook(tables));
    writer.write("codebook.csv", toCsv(tables.back()));
    writer.write("codebook.json", codebookJson(tables));
    for (const ExportedFile& file : more) writer.write(file.path, file.bytes);
    writer.write("README.md", readmeText(*study, tables, more, options.samples));
    if (options.samples) writeSamples(reader, *study, options, writer);
    if (writer.failed()) return writer.errors();
    if (options.in_folder) {
        if (const auto done = folder->letAdd(options.in_folder); !done) return done.errors();
    }
    const auto kept = folder->complete();
    if (!kept) return kept.errors();
    return ExportReport{study->attempts.size(), writer.files() + 1, reader.damages().size(), *kept};
}

}  // namespace passung::exporter
