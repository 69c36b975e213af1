#include <QtCore/QCommandLineParser>
#include <QtCore/QDir>
#include <QtCore/QLocale>
#include <QtCore/QStandardPaths>
#include <QtGui/QGuiApplication>
#include <QtQuickControls2/QQuickStyle>
#include <cstdio>
#include <exception>

#include "ui/window/app.h"

// The program passung-window: both windows. `passung` becomes it when it is called without arguments.

namespace {

/// The nearest folder "protocols" beside or above the program.
QString shippedStudies() {
    for (QDir folder(QCoreApplication::applicationDirPath());;) {
        if (folder.exists("protocols")) return folder.filePath("protocols");
        if (!folder.cdUp()) return "protocols";
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        QQuickStyle::setStyle("Basic");
        QGuiApplication application(argc, argv);
        QCoreApplication::setApplicationName("passung");
        QCommandLineParser parser;
        parser.setApplicationDescription("Passung: the windows of experimenter and participant");
        parser.addHelpOption();
        parser.addPositionalArgument("FOLDER", "of the studies, each in a folder of its own with a study.toml");
        parser.addOptions({{"language", "en or de", "LANGUAGE", QLocale::system().name().left(2)},
                           {"light", "dark text on a light ground"}});
        parser.process(application);
        passung::window::AppOptions options;
        const QStringList folders = parser.positionalArguments();
        options.protocols = (folders.isEmpty() ? shippedStudies() : folders.front()).toStdString();
        options.data = QStandardPaths::writableLocation(QStandardPaths::AppDataLocation).toStdString() + "/tryouts";
        options.language = parser.value("language") == "de" ? "de" : "en";
        options.dark = !parser.isSet("light");
        passung::window::App app(options);
        return QGuiApplication::exec();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
    }
}
