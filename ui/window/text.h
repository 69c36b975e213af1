#pragma once

#include <QtCore/QString>
#include <string>

namespace passung::window {

/// A text of the study, in UTF-8, for the windows.
inline QString text(const std::string& utf8) { return QString::fromStdString(utf8); }

}  // namespace passung::window
