#pragma once

#include <QtCore/QLocale>
#include <QtCore/QString>
#include <QtCore/QTranslator>
#include <string>

namespace passung::window {

/// What the participant's window says, in the session's language, whatever the experimenter's is.
class Speech {
public:
    void speak(const std::string& language);
    /// A text of the context "participant".
    QString operator()(const char* text) const;
    QString number(double value, int decimals) const { return locale_.toString(value, 'f', decimals); }

private:
    std::string language_ = "en";
    QLocale locale_{QLocale::English};
    QTranslator translator_;
};

}  // namespace passung::window
