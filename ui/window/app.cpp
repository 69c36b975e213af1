#include "ui/window/app.h"

#include <QtCore/QCoreApplication>
#include <QtGui/QGuiApplication>
#include <QtGui/QOffscreenSurface>
#include <QtGui/QOpenGLContext>
#include <QtGui/QOpenGLFunctions>
#include <QtGui/QScreen>
#include <QtQml/QQmlContext>
#include <QtQuick/QSGRendererInterface>
#include <stdexcept>

#include "ui/experimenter/strip_item.h"

namespace passung::window {

namespace {

constexpr int kMirrorEvery = 150;  // [ms]

/// Is there no graphics card, so that the processor draws?
bool drawsInSoftware() {
    QOpenGLContext context;
    QOffscreenSurface surface;
    surface.create();
    if (!context.create() || !context.makeCurrent(&surface)) return true;
    const auto* name = reinterpret_cast<const char*>(context.functions()->glGetString(GL_RENDERER));
    const QString renderer = QString::fromLatin1(name);
    context.doneCurrent();
    return renderer.contains(QLatin1String("llvmpipe")) || renderer.contains(QLatin1String("softpipe"));
}

}  // namespace

App::App(const AppOptions& options)
    : look_(options.dark),
      desk_(options.data),
      memory_(QString::fromStdString(options.data) + "/windows.ini", QSettings::IniFormat),
      studies_(desk_, options.protocols, options.data),
      roster_(desk_, studies_),
      records_(desk_, studies_, replay_),
      details_(desk_, studies_),
      run_(desk_),
      form_(desk_, speech_),
      guide_(desk_, speech_),
      screen_(desk_, 0),
      mirror_(desk_, kMirrorEvery),
      places_(QString::fromStdString(options.data) + "/windows.ini") {
    look_.setScale(options.text_scale);
    setLanguage(options.language);
    remember();
    connect(&desk_, &Desk::opened, this, [this] { speech_.speak(desk_.language()); });
    qmlRegisterType<experimenter::TraceItem>("Passung", 1, 0, "TraceItem");
    qmlRegisterType<experimenter::StripItem>("Passung", 1, 0, "StripItem");
    QQmlContext& context = *engine_.rootContext();
    context.setContextProperty("app", this);
    context.setContextProperty("look", &look_);
    context.setContextProperty("studies", &studies_);
    context.setContextProperty("roster", &roster_);
    context.setContextProperty("records", &records_);
    context.setContextProperty("replay", &replay_);
    context.setContextProperty("details", &details_);
    context.setContextProperty("run", &run_);
    context.setContextProperty("form", &form_);
    context.setContextProperty("guide", &guide_);
    context.setContextProperty("screenView", &screen_);
    context.setContextProperty("mirrorView", &mirror_);
    const bool software = drawsInSoftware();
    screen_.setSoftware(software);
    mirror_.setSoftware(software);
    replay_.setSoftware(software);
    engine_.load(QUrl("qrc:/ui/experimenter/Console.qml"));
    engine_.load(QUrl("qrc:/ui/participant/Participant.qml"));
    for (QObject* root : engine_.rootObjects()) {
        auto* window = qobject_cast<QQuickWindow*>(root);
        if (window != nullptr && window->objectName() == "participant") participant_ = window;
        if (window != nullptr && window->objectName() == "experimenter") experimenter_ = window;
    }
    if (experimenter_ == nullptr || participant_ == nullptr) throw std::runtime_error("the windows cannot be made");
    watchGraphics();
    places_.restore("experimenter", *experimenter_);
    places_.restore("participant", *participant_);
    experimenter_->show();
    connect(&desk_, &Desk::opened, this, &App::placeParticipant);
    for (QQuickWindow* window : {experimenter_, participant_})
        for (const auto moved :
             {&QWindow::xChanged, &QWindow::yChanged, &QWindow::widthChanged, &QWindow::heightChanged})
            connect(window, moved, this, &App::keepPlaces);
}

/// On a screen of their own, if there is one, the participant sees nothing else.
void App::placeParticipant() {
    const auto screens = QGuiApplication::screens();
    QList<QRect> areas;
    for (const QScreen* screen : screens) areas.append(screen->geometry());
    const auto own = participantScreen(areas, experimenter_->geometry());
    if (own && !participant_->isVisible()) {
        participant_->setScreen(screens[*own]);
        participant_->setGeometry(areas[*own]);
    }
    screen_.setFullScreen(own.has_value());
}

/// What tells of losses is queued, what measures is not: both may come from the thread that draws.
void App::watchGraphics() {
    const auto lost = [this] { screen_.setDrawing(false); };
    const auto regained = [this] { screen_.setDrawing(true); };
    connect(participant_, &QQuickWindow::sceneGraphError, this, lost, Qt::QueuedConnection);
    connect(participant_, &QQuickWindow::sceneGraphInvalidated, this, lost, Qt::QueuedConnection);
    connect(participant_, &QQuickWindow::sceneGraphInitialized, this, regained, Qt::QueuedConnection);
    app::FrameClock& frames = desk_.frames();
    connect(
        participant_, &QQuickWindow::afterSynchronizing, this, [&frames] { frames.take(); }, Qt::DirectConnection);
    connect(
        participant_, &QQuickWindow::frameSwapped, this, [&frames] { frames.present(app::steadyNanoseconds()); },
        Qt::DirectConnection);
}

App::~App() { desk_.close(); }

void App::keepPlaces() {
    places_.keep("experimenter", *experimenter_);
    places_.keep("participant", *participant_);
}

void App::remember() {
    page_ = memory_.value("page", "studies").toString();
    if (page_ == "session") page_ = "studies";  // there is none yet
    roster_.setProperty("experimenter", memory_.value("experimenter").toString());
    connect(&roster_, &RosterModel::experimenterChanged, this,
            [this] { memory_.setValue("experimenter", roster_.experimenter()); });
}

void App::setPage(const QString& page) {
    if (page == page_) return;
    page_ = page;
    memory_.setValue("page", page);
    emit pageChanged();
}

void App::setLanguage(const QString& language) {
    if (language == language_) return;
    language_ = language;
    QCoreApplication::removeTranslator(&translator_);
    if (language_ != "en" && translator_.load(QStringLiteral(":/texts/passung_%1.qm").arg(language_)))
        QCoreApplication::installTranslator(&translator_);
    engine_.retranslate();
    studies_.retranslate();
    roster_.retranslate();
    records_.retranslate();
    details_.retranslate();
    run_.retranslate();
    screen_.retranslate();
    if (!desk_.run().view().isRunning()) speech_.speak(language_.toStdString());
    form_.retranslate();
    guide_.retranslate();
    emit languageChanged();
}

}  // namespace passung::window
