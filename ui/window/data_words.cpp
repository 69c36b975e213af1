#include "ui/window/data_words.h"

#include <QtCore/QCoreApplication>

#include "study/measures/measures.h"
#include "ui/presenter/run.h"
#include "ui/window/participants_words.h"
#include "ui/window/words.h"

namespace passung::window {

namespace {

QString said(const char* text) { return QCoreApplication::translate("data", text); }

}  // namespace

QString kindText(const std::string& kind) {
    const auto known = plan::participantKindNamed(kind);
    return known ? kindWord(*known) : QString::fromStdString(kind);
}

QString endWord(const std::optional<std::string>& end_state) {
    using presenter::SessionEnd;
    if (!end_state) return sessionWord(SessionEnd::Open);
    return sessionWord(*end_state == "complete"  ? SessionEnd::Complete
                       : *end_state == "crashed" ? SessionEnd::Crashed
                                                 : SessionEnd::Aborted);
}

QString outcomeWord(const std::string& outcome, bool valid) {
    using presenter::RowState;
    if (outcome == "running") return rowWord(RowState::Running);
    if (outcome == "crashed") return said(QT_TRANSLATE_NOOP("data", "crashed"));
    if (outcome == "aborted") return rowWord(RowState::Aborted);
    if (!valid) return rowWord(RowState::Invalid);
    return rowWord(outcome == "success"   ? RowState::Success
                   : outcome == "timeout" ? RowState::Timeout
                                          : RowState::Failure);
}

QString attemptTitle(const store::AttemptRow& row) {
    return said(QT_TRANSLATE_NOOP("data", "%1 · session %2 · trial %3, attempt %4 · %5"))
        .arg(QString::fromStdString(row.participant_id))
        .arg(row.session_ordinal)
        .arg(row.trial_index + 1)
        .arg(row.attempt_no)
        .arg(QString::fromStdString(row.presented_condition));
}

QString exportedLine(const QString& folder, std::size_t attempts, std::size_t files, std::size_t missing) {
    if (missing > 0)
        return said(QT_TRANSLATE_NOOP("data", "%1: %2 attempts in %3 files; damaged and left out: %4, see missing.csv"))
            .arg(folder)
            .arg(attempts)
            .arg(files)
            .arg(missing);
    return said(QT_TRANSLATE_NOOP("data", "%1: %2 attempts in %3 files")).arg(folder).arg(attempts).arg(files);
}

QString keptExportLine(const QString& kept) {
    return said(QT_TRANSLATE_NOOP("data", "The earlier export may hold what is damaged now: kept as %1")).arg(kept);
}

QString damagedLine(std::size_t damages) {
    return said(QT_TRANSLATE_NOOP("data", "Damaged and left out here: %1; passung verify names each")).arg(damages);
}

QString reportNeedsLine(const QString& command) {
    return said(QT_TRANSLATE_NOOP("data", "The report's page needs what is not installed: %1")).arg(command);
}

QString reportFailedLine(const QString& words) {
    return said(QT_TRANSLATE_NOOP("data", "R made no report of analysis.Rmd: %1")).arg(words);
}

QString cancelledLine() { return said(QT_TRANSLATE_NOOP("data", "The export was cancelled; nothing was written.")); }

}  // namespace passung::window
