#pragma once

#include <QtCore/QString>
#include <string>

namespace passung::window {

// What the rooms below name in English, in the language of the window; what is not known stays as it is.

/// Of the label of a measure.
QString measureWord(const std::string& label);
/// Of the label of a device.
QString deviceWord(const std::string& label);

}  // namespace passung::window
