#include "ui/window/speech.h"

namespace passung::window {

void Speech::speak(const std::string& language) {
    if (language == language_) return;
    language_ = language;
    locale_ = QLocale(QString::fromStdString(language));
    locale_.setNumberOptions(QLocale::OmitGroupSeparator);
    if (!translator_.load(QStringLiteral(":/texts/passung_%1.qm").arg(QString::fromStdString(language))))
        static_cast<void>(translator_.load(QString()));  // then the texts are English
}

QString Speech::operator()(const char* text) const {
    const QString said = translator_.translate("participant", text);
    return said.isEmpty() ? QString::fromUtf8(text) : said;
}

}  // namespace passung::window
