#include "ui/window/data_model.h"

#include <QtCore/QCoreApplication>
#include <QtCore/QStandardPaths>
#include <algorithm>
#include <filesystem>

#include "study/run/files/known_exports.h"
#include "ui/presenter/axis.h"
#include "ui/window/data_words.h"
#include "ui/window/registry_words.h"
#include "ui/window/text.h"

namespace passung::window {

using presenter::Recorded;

namespace {

using Found = std::shared_ptr<Recorded>;  // shared: through the event loop; null: no database

Result<Found> readFrom(const std::string& database, store::Damaged damaged) {
    if (!std::filesystem::exists(database)) return Found();
    const auto reader = store::StoreReader::open(database, damaged);
    if (!reader) return reader.errors();
    auto recorded = presenter::readRecorded(*reader);
    if (!recorded) return recorded.errors();
    return std::make_shared<Recorded>(*std::move(recorded));
}

QVariantList numbers(const std::vector<double>& values) {
    QVariantList all;
    for (const double value : values) all.append(value);
    return all;
}

QVariantMap lookMap(const presenter::ConditionSummary& look) {
    const presenter::FiveNumbers& n = look.numbers;
    return {{"condition", text(look.version.empty() ? look.condition : look.condition + " (" + look.version + ")")},
            {"participants", static_cast<int>(look.participants)},
            {"n", static_cast<int>(look.values.size())},
            {"values", numbers(look.values)},
            {"box", numbers(look.values.empty() ? std::vector<double>{}
                                                : std::vector{n.least, n.lower, n.median, n.upper, n.most})}};
}

}  // namespace

DataModel::DataModel(Desk& desk, Studies& studies, ReplayModel& replay)
    : desk_(desk), studies_(studies), replay_(replay) {
    connect(&studies_, &Studies::chosenChanged, this, [this] {
        told_.clear();
        replay_.close();
        refresh();
    });
    connect(&desk_, &Desk::happened, this, [this] {
        const presenter::RunView& run = desk_.run().view();
        std::int64_t ended = 0;
        for (const presenter::TrialRow& row : run.rows) ended += row.attempts;
        const bool begins = !ran_ && run.isRunning() && run.planned > 0, more = ran_ && ended != ended_;
        const bool ends = ran_ && !run.isRunning();
        if (begins || more || ends) read(begins || ends || whole_ != database().toStdString());
        ran_ = run.isRunning() && run.planned > 0;
        ended_ = ended;
    });
    refresh();
}

QString DataModel::database() const {
    return source_ == 2 ? file_ : text(source_ == 1 ? studies_.tryOuts() : studies_.database());
}

void DataModel::setSource(int source) {
    if (source == source_) return;
    source_ = source;
    told_.clear();
    replay_.close();
    refresh();
}

void DataModel::setFile(const QString& file) {
    if (file == file_) return;
    file_ = file;
    if (source_ == 2) refresh();
}

/// A file that was whole is not searched for damage again after each trial.
void DataModel::read(bool looks) {
    const int asked = ++asked_;
    const auto damaged = looks ? store::Damaged::LeftOut : store::Damaged::KnownWhole;
    if (looks) whole_.clear();
    worker_.run([database = database().toStdString(), damaged] { return readFrom(database, damaged); },
                [this, asked, of = database().toStdString()](Result<Found> found) {
                    if (asked != asked_) return;
                    if (found && *found && (*found)->damages == 0) whole_ = of;
                    recorded_.reset();
                    failed_ = !found || (*found && (*found)->damages > 0);
                    if (!found)
                        told_ = text(toString(found.errors().front()));
                    else if (*found)
                        recorded_ = std::make_unique<Recorded>(std::move(**found));
                    if (recorded_ && recorded_->damages > 0) told_ = damagedLine(recorded_->damages);
                    if (attempts().isEmpty()) session_.clear();
                    if (session_.empty() && recorded_ && !recorded_->data.sessions.empty())
                        session_ = recorded_->data.sessions.back().session_id;
                    if (recorded_ && measure_ >= static_cast<int>(recorded_->measures.size()))
                        measure_ = static_cast<int>(presenter::firstMeasure(*recorded_));
                    if (!recorded_ || kind_ >= static_cast<int>(recorded_->kinds.size())) kind_ = 0;
                    emit changed();
                });
    emit changed();
}

QVariantList DataModel::sessions() const {
    QVariantList all;
    if (!recorded_) return all;
    for (const store::SessionRow& row : recorded_->data.sessions) {
        const bool whole = row.end_state == "complete";
        all.append(QVariantMap{{"id", text(row.session_id)},
                               {"participant", text(row.participant_id)},
                               {"ordinal", static_cast<int>(row.ordinal)},
                               {"kind", kindText(row.kind)},
                               {"date", row.epoch == "virtual" ? QString() : text(row.started_utc.substr(0, 10))},
                               {"word", endWord(row.end_state)},
                               {"tone", whole           ? "good"
                                        : row.end_state ? "wait"
                                                        : "rest"},
                               {"trials", QStringLiteral("%1 / %2").arg(row.valid_attempts).arg(row.planned_trials)}});
    }
    return all;
}

void DataModel::setSession(const QString& session) {
    if (session == this->session()) return;
    session_ = session.toStdString();
    emit changed();
}

QVariantList DataModel::attempts() const {
    QVariantList all;
    if (!recorded_) return all;
    for (const store::AttemptRow* row : presenter::attemptsOf(*recorded_, session_)) {
        const auto time = row->measures.find("time_s");
        const bool good = row->valid && row->outcome == "success";
        all.append(QVariantMap{{"id", static_cast<qlonglong>(row->attempt_id)},
                               {"trial", static_cast<int>(row->trial_index) + 1},
                               {"attempt", static_cast<int>(row->attempt_no)},
                               {"block", text(row->block)},
                               {"condition", text(row->presented_condition)},
                               {"word", outcomeWord(row->outcome, row->valid)},
                               {"reason", text(row->invalid_reason.value_or(""))},
                               {"tone", good                                      ? "good"
                                        : row->valid && row->outcome == "timeout" ? "wait"
                                                                                  : "bad"},
                               {"seconds", time != row->measures.end() ? time->second
                                           : row->end_ns ? 1e-9 * static_cast<double>(*row->end_ns - row->start_ns)
                                                         : -1.0}});
    }
    return all;
}

void DataModel::showAgain(int attempt) {
    if (!recorded_) return;
    const auto rows = presenter::attemptsOf(*recorded_, session_);
    if (attempt < 0 || attempt >= static_cast<int>(rows.size())) return;
    const store::AttemptRow& row = *rows[static_cast<std::size_t>(attempt)];
    // The protocol's file is where its meshes are; a database from elsewhere has them beside it.
    const presenter::StudyCard* card = studies_.card();
    const std::string meshes =
        source_ == 2 || card == nullptr ? "" : std::filesystem::path(card->path).parent_path().string();
    again_ = row.attempt_id;
    replay_.show(database().toStdString(), meshes, row.attempt_id, attemptTitle(row));
}

QVariantList DataModel::measures() const {
    QVariantList all;
    if (recorded_)
        for (const auto& measure : recorded_->measures)
            all.append(QVariantMap{
                {"name", text(measure.name)},
                {"label", measureWord(measure.label) + (measure.unit.empty() || measure.unit == "1"
                                                            ? QString()
                                                            : QStringLiteral(" [%1]").arg(text(measure.unit)))}});
    return all;
}

void DataModel::setMeasure(int measure) {
    if (measure == measure_ || measure < 0) return;
    measure_ = measure;
    emit changed();
}

QStringList DataModel::kinds() const {
    QStringList all;
    if (recorded_)
        for (const auto& kind : recorded_->kinds) all.append(kindText(kind));
    return all;
}

void DataModel::setKind(int kind) {
    if (kind == kind_ || kind < 0) return;
    kind_ = kind;
    emit changed();
}

QVariantMap DataModel::look() const {
    if (!recorded_ || recorded_->measures.empty() || recorded_->kinds.empty()) return {};
    const auto& measure = recorded_->measures[static_cast<std::size_t>(measure_)];
    const auto looks = presenter::lookAt(*recorded_, measure.name, recorded_->kinds[static_cast<std::size_t>(kind_)]);
    QVariantList rows;
    double low = INFINITY, high = -INFINITY;
    for (const auto& look : looks) {
        rows.append(lookMap(look));
        if (look.values.empty()) continue;
        low = std::min(low, look.numbers.least);
        high = std::max(high, look.numbers.most);
    }
    if (!(low <= high)) low = high = 0.0;
    if (low > 0.0 && low < 0.5 * high) low = 0.0;  // a scale that begins at nothing, where that costs little room
    return {{"rows", rows}, {"marks", numbers(presenter::axisMarks(low, high, 6))}};
}

QString DataModel::proposedFolder() const {
    const QString documents = QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation);
    const presenter::StudyCard* card = studies_.card();
    return documents + "/passung-export/" + (card != nullptr ? text(card->name) : QStringLiteral("study"));
}

namespace {

/// The tables, with the planned analyses or without.
Result<report::ReportOutcome> writeFolder(const std::string& database, const std::string& folder, bool with_report,
                                          const exporter::ExportOptions& options) {
    const auto reader = store::StoreReader::open(
        database, options.samples ? store::Damaged::LeftOutWithSamples : store::Damaged::LeftOut);
    if (!reader) return reader.errors();
    std::error_code problem;  // shows when the folder is begun
    std::filesystem::create_directories(std::filesystem::path(folder).parent_path(), problem);
    report::ReportOutcome outcome;
    if (with_report) {
        auto written = report::writeReport(*reader, folder, options);
        if (!written) return written.errors();
        outcome = *std::move(written);
    } else {
        auto tables = exporter::exportAll(*reader, folder, options);
        if (!tables) return tables.errors();
        outcome.tables = *std::move(tables);
    }
    run::rememberExport(database, folder);
    if (!outcome.tables.kept.empty()) run::rememberExport(database, outcome.tables.kept);
    return outcome;
}

}  // namespace

void DataModel::write(const QString& folder, bool samples, bool with_report) {
    if (exporting_ || !recorded_ || folder.trimmed().isEmpty()) return;
    exporting_ = true;
    reporting_ = with_report;
    exported_ = 0.0;
    cancelled_ = false;
    last_folder_.clear();
    last_report_.clear();
    told_.clear();
    exporter::ExportOptions options;
    options.samples = samples;
    options.cancelled = [this] { return cancelled_.load(); };
    options.progress = [this](double share) {
        QMetaObject::invokeMethod(
            this,
            [this, share] {
                exported_ = share;
                emit exportChanged();
            },
            Qt::QueuedConnection);
    };
    const QString to = folder.trimmed();
    worker_.run([database = database().toStdString(), out = to.toStdString(), with_report,
                 options] { return writeFolder(database, out, with_report, options); },
                [this, to](const Result<report::ReportOutcome>& outcome) {
                    exporting_ = false;
                    tellWritten(to, outcome);
                    emit changed();
                    emit exportChanged();
                });
    emit exportChanged();
}

void DataModel::tellWritten(const QString& folder, const Result<report::ReportOutcome>& outcome) {
    failed_ = true;
    if (!outcome) {
        told_ = cancelled_ ? cancelledLine() : text(toString(outcome.errors().front()));
        return;
    }
    const exporter::ExportReport& tables = outcome->tables;
    failed_ = tables.missing > 0 || !outcome->failed.empty();
    last_folder_ = folder;
    told_ = exportedLine(folder, tables.attempts, tables.files, tables.missing);
    if (!tables.kept.empty()) told_ += "\n" + keptExportLine(text(tables.kept));
    if (!reporting_) return;
    if (!outcome->missing.empty())
        told_ += "\n" + reportNeedsLine(text(outcome->missing));
    else if (!outcome->failed.empty())
        told_ += "\n" + reportFailedLine(text(outcome->failed));
    else
        last_report_ = folder + "/report.html";
    for (const std::string& line : outcome->said) told_ += "\n" + text(line);
}

void DataModel::retranslate() {
    told_.clear();  // said in the language before
    if (recorded_)
        for (const store::AttemptRow& row : recorded_->data.attempts)
            if (row.attempt_id == again_) replay_.setTitle(attemptTitle(row));
    emit changed();
}

}  // namespace passung::window
