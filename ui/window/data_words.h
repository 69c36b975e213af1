#pragma once

#include <QtCore/QString>
#include <optional>
#include <string>

#include "study/store/rows/rows.h"

namespace passung::window {

// What a database's words mean, in the language of the windows.

QString kindText(const std::string& kind);
QString endWord(const std::optional<std::string>& end_state);
QString attemptTitle(const store::AttemptRow& row);
QString outcomeWord(const std::string& outcome, bool valid);
QString exportedLine(const QString& folder, std::size_t attempts, std::size_t files, std::size_t missing);

/// Where an earlier export is that the new one did not replace.
QString keptExportLine(const QString& kept);
QString cancelledLine();

/// `command` installs what R lacks.
QString reportNeedsLine(const QString& command);
/// `words`: the last that R said.
QString reportFailedLine(const QString& words);

QString damagedLine(std::size_t damages);

}  // namespace passung::window
