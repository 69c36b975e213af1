#include <time.h>
#include <unistd.h>
#include <QtCore/QCommandLineParser>
#include <QtCore/QDir>
#include <QtCore/QFile>
#include <QtCore/QLocale>
#include <QtCore/QStandardPaths>
#include <QtGui/QGuiApplication>
#include <QtQuickControls2/QQuickStyle>

#include <algorithm>
#include <cstdio>
#include <ctime>
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

/// Of this process; the system counts its start in hundredths of a second.
double millisecondsSinceStart() {
    QFile file("/proc/self/stat");
    if (!file.open(QIODevice::ReadOnly)) return 0.0;
    const QByteArray text = file.readAll();
    const auto fields = text.mid(text.lastIndexOf(')') + 2).split(' ');  // from the third on
    const double started_s = fields.value(19).toDouble() / static_cast<double>(sysconf(_SC_CLK_TCK));
    timespec now{};
    clock_gettime(CLOCK_BOOTTIME, &now);
    return 1e3 * (static_cast<double>(now.tv_sec) - started_s) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        QQuickStyle::setStyle("Basic");
        if (const QByteArray platform = passung::window::platformFor(qgetenv("DISPLAY"), qgetenv("QT_QPA_PLATFORM"));
            !platform.isEmpty())
            qputenv("QT_QPA_PLATFORM", platform);
        QGuiApplication application(argc, argv);
        QCoreApplication::setApplicationName("passung");
        QCommandLineParser parser;
        parser.setApplicationDescription("Passung: the windows of experimenter and participant");
        parser.addHelpOption();
        parser.addPositionalArgument("FOLDER", "of the studies, each in a folder of its own with a study.toml");
        parser.addOptions({{"language", "en or de", "LANGUAGE", QLocale::system().name().left(2)},
                           {"light", "dark text on a light ground"},
                           {"text-size", "in percent, 75 to 200", "PERCENT", "100"},
                           {"first-picture", "say how long the first picture took from the program's start, and end"}});
        parser.process(application);
        passung::window::AppOptions options;
        const QStringList folders = parser.positionalArguments();
        options.protocols = (folders.isEmpty() ? shippedStudies() : folders.front()).toStdString();
        options.data = QStandardPaths::writableLocation(QStandardPaths::AppDataLocation).toStdString() + "/tryouts";
        options.language = parser.value("language") == "de" ? "de" : "en";
        options.dark = !parser.isSet("light");
        options.text_scale = std::clamp(0.01 * parser.value("text-size").toDouble(), 0.75, 2.0);
        passung::window::App app(options);
        if (parser.isSet("first-picture"))
            QObject::connect(
                app.experimenter(), &QQuickWindow::frameSwapped, &app,
                [] {
                    std::printf("first picture after %.0f ms, %.0f ms of processor time\n", millisecondsSinceStart(),
                                1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC);
                    QCoreApplication::quit();
                },
                static_cast<Qt::ConnectionType>(Qt::QueuedConnection | Qt::SingleShotConnection));
        return QGuiApplication::exec();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
    }
}
