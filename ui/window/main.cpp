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
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <iterator>
#include <memory>
#include <stdexcept>

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

void describeOptions(QCommandLineParser& parser) {
    parser.setApplicationDescription("Passung: the windows of experimenter and participant");
    parser.addHelpOption();
    parser.addPositionalArgument("FOLDER", "of the studies, each in a folder of its own with a study.toml");
    parser.addOptions({{"language", "en or de", "LANGUAGE", QLocale::system().name().left(2)},
                       {"light", "dark text on a light ground"},
                       {"text-size", "in percent, 75 to 200", "PERCENT", "100"},
                       {"first-picture", "say how long the first picture took from the program's start, and end"}});
}

constexpr const char* kHelp[] = {"-h", "--help", "--help-all"};

/// Prints the help, which needs no display, and ends the program where it is asked for.
void helpWithoutDisplay(int argc, char** argv) {
    const auto asks = [](const char* argument) {
        return std::any_of(std::begin(kHelp), std::end(kHelp),
                           [argument](const char* help) { return std::strcmp(argument, help) == 0; });
    };
    if (!std::any_of(argv + 1, argv + argc, asks)) return;
    const QCoreApplication application(argc, argv);
    QCommandLineParser parser;
    describeOptions(parser);
    parser.showHelp();
}

/// Qt aborts where no display answers; one line takes the place of its words.
void endWithoutDisplay(QtMsgType type, const QMessageLogContext&, const QString&) {
    if (type != QtFatalMsg) return;
    std::fprintf(stderr,
                 "error: no display: the windows need one that answers (DISPLAY=\"%s\", WAYLAND_DISPLAY=\"%s\"); "
                 "\"passung --help\" lists what works without\n",
                 qgetenv("DISPLAY").constData(), qgetenv("WAYLAND_DISPLAY").constData());
    std::_Exit(1);
}

/// The application with its connection to a display, or the program's end.
std::unique_ptr<QGuiApplication> connectToDisplay(int& argc, char** argv) {
    const auto usual = qInstallMessageHandler(endWithoutDisplay);
    auto application = std::make_unique<QGuiApplication>(argc, argv);
    qInstallMessageHandler(usual);
    return application;
}

passung::window::AppOptions optionsOf(const QCommandLineParser& parser) {
    const auto refuse = [](const QString& what) { throw std::runtime_error(what.toStdString()); };
    passung::window::AppOptions options;
    const QStringList folders = parser.positionalArguments();
    if (!folders.isEmpty() && !QDir(folders.front()).exists()) refuse(folders.front() + ": no such folder");
    options.protocols = (folders.isEmpty() ? shippedStudies() : folders.front()).toStdString();
    options.data = QStandardPaths::writableLocation(QStandardPaths::AppDataLocation).toStdString() + "/tryouts";
    const QString language = parser.value("language");
    if (parser.isSet("language") && language != "en" && language != "de")
        refuse("--language: \"" + language + "\": must be en or de");
    options.language = language == "de" ? "de" : "en";
    options.dark = !parser.isSet("light");
    bool is_number = false;
    const double percent = parser.value("text-size").toDouble(&is_number);
    if (!is_number || !(percent >= 75.0 && percent <= 200.0))
        refuse("--text-size: \"" + parser.value("text-size") + "\": must be a number from 75 to 200");
    options.text_scale = 0.01 * percent;
    return options;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        helpWithoutDisplay(argc, argv);
        QQuickStyle::setStyle("Basic");
        if (const QByteArray platform = passung::window::platformFor(qgetenv("DISPLAY"), qgetenv("QT_QPA_PLATFORM"));
            !platform.isEmpty())
            qputenv("QT_QPA_PLATFORM", platform);
        const auto application = connectToDisplay(argc, argv);
        QCoreApplication::setApplicationName("passung");
        QCommandLineParser parser;
        describeOptions(parser);
        parser.process(*application);
        passung::window::App app(optionsOf(parser));
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
