#include "ui/window/app.h"

#include <QtCore/QCoreApplication>
#include <QtGui/QGuiApplication>
#include <QtGui/QOffscreenSurface>
#include <QtGui/QOpenGLContext>
#include <QtGui/QOpenGLFunctions>
#include <QtGui/QScreen>
#include <QtQml/QQmlComponent>
#include <QtQml/QQmlContext>
#include <QtQuick/QSGRendererInterface>
#include <stdexcept>

#include "ui/experimenter/strip_item.h"
#include "ui/participant/part_geometry.h"
#include "ui/participant/part_instances.h"

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
      participants_(desk_, studies_),
      records_(desk_, studies_, replay_),
      details_(desk_, studies_),
      accuracy_(desk_, studies_, options.accuracy),
      run_(desk_),
      form_(desk_, speech_),
      guide_(desk_, speech_),
      screen_(desk_, 0),
      mirror_(desk_, kMirrorEvery),
      quality_(desk_, options.quality),
      places_(QString::fromStdString(options.data) + "/windows.ini") {
    look_.setScale(options.text_scale);
    setLanguage(options.language);
    remember();
    connect(&desk_, &Desk::opened, this, [this] { speech_.speak(desk_.language()); });
    qmlRegisterType<experimenter::TraceItem>("Passung", 1, 0, "TraceItem");
    qmlRegisterType<experimenter::StripItem>("Passung", 1, 0, "StripItem");
    qmlRegisterType<participant::PartGeometry>("Passung", 1, 0, "PartGeometry");
    qmlRegisterType<participant::PartInstances>("Passung", 1, 0, "PartInstances");
    QQmlContext& context = *engine_.rootContext();
    context.setContextProperty("app", this);
    context.setContextProperty("look", &look_);
    context.setContextProperty("studies", &studies_);
    context.setContextProperty("participants", &participants_);
    context.setContextProperty("cutOff", &cut_off_);
    context.setContextProperty("records", &records_);
    context.setContextProperty("replay", &replay_);
    context.setContextProperty("details", &details_);
    context.setContextProperty("accuracy", &accuracy_);
    context.setContextProperty("run", &run_);
    context.setContextProperty("form", &form_);
    context.setContextProperty("guide", &guide_);
    context.setContextProperty("screenView", &screen_);
    context.setContextProperty("mirrorView", &mirror_);
    context.setContextProperty("stopPath", &stop_path_);
    context.setContextProperty("pictureQuality", &quality_);
    context.setContextProperty("screenChoice", &screen_choice_);
    const bool software = drawsInSoftware();
    screen_.setSoftware(software);
    mirror_.setSoftware(software);
    replay_.setSoftware(software);
    engine_.load(QUrl("qrc:/ui/experimenter/Console.qml"));
    for (QObject* root : engine_.rootObjects()) experimenter_ = qobject_cast<QQuickWindow*>(root);
    if (experimenter_ == nullptr) throw std::runtime_error("the windows cannot be made");
    makeParticipant();
    watchGraphics();
    quality_.attach(participant_.get(), participant_->findChild<QQuickItem*>("scene"));
    connect(&desk_, &Desk::frame, participant_.get(),
            &QQuickWindow::update);  // a picture of every look, also of a part at rest
    stop_path_.attach({experimenter_, participant_.get()}, experimenter_->findChild<QQuickItem*>("stop"));
    places_.restore("experimenter", *experimenter_);
    places_.restore("participant", *participant_);
    experimenter_->setGeometry(fitting(experimenter_->geometry(), experimenter_->screen()->availableGeometry()));
    experimenter_->show();
    connect(&desk_, &Desk::happened, this, &App::dressParticipant);
    screen_choice_.attach(experimenter_, participant_.get());
    for (QQuickWindow* window : {experimenter_, participant_.get()})
        for (const auto moved :
             {&QWindow::xChanged, &QWindow::yChanged, &QWindow::widthChanged, &QWindow::heightChanged})
            connect(window, moved, this, &App::keepPlaces);
}

/// In the participant's window `look` is the study's, not the console's.
void App::makeParticipant() {
    participant_context_.setContextProperty("look", &participant_look_);
    QQmlComponent component(&engine_, QUrl("qrc:/ui/participant/Participant.qml"));
    std::unique_ptr<QObject> made(component.create(&participant_context_));
    participant_.reset(qobject_cast<QQuickWindow*>(made.get()));
    if (participant_ == nullptr) throw std::runtime_error(component.errorString().toStdString());
    static_cast<void>(made.release());
}

void App::dressParticipant() {
    const plan::View& appearance = desk_.run().appearance();
    participant_look_.setDark(appearance.theme == plan::Theme::Dark);
    participant_look_.setScale(appearance.text_scale);
}

/// What tells of losses is queued, what measures is not: both may come from the thread that draws.
void App::watchGraphics() {
    const auto lost = [this] { screen_.setDrawing(false); };
    const auto regained = [this] { screen_.setDrawing(true); };
    connect(participant_.get(), &QQuickWindow::sceneGraphError, this, lost, Qt::QueuedConnection);
    connect(participant_.get(), &QQuickWindow::sceneGraphInvalidated, this, lost, Qt::QueuedConnection);
    connect(participant_.get(), &QQuickWindow::sceneGraphInitialized, this, regained, Qt::QueuedConnection);
    run::FrameClock& frames = desk_.frames();
    connect(
        participant_.get(), &QQuickWindow::afterSynchronizing, this, [&frames] { frames.take(); },
        Qt::DirectConnection);
    connect(
        participant_.get(), &QQuickWindow::frameSwapped, this, [&frames] { frames.present(run::steadyNanoseconds()); },
        Qt::DirectConnection);
}

App::~App() {
    desk_.close();
    cut_off_.close();
    stop_path_.detach();
}

void App::keepPlaces() {
    places_.keep("experimenter", *experimenter_);
    places_.keep("participant", *participant_);
}

void App::remember() {
    page_ = memory_.value("page", "studies").toString();
    if (page_ == "session") page_ = "studies";  // there is none yet
    if (cut_off_.find()) page_ = "participants";
    participants_.setProperty("experimenter", memory_.value("experimenter").toString());
    connect(&participants_, &ParticipantsModel::experimenterChanged, this,
            [this] { memory_.setValue("experimenter", participants_.experimenter()); });
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
    participants_.retranslate();
    records_.retranslate();
    details_.retranslate();
    accuracy_.retranslate();
    run_.retranslate();
    screen_.retranslate();
    if (!desk_.run().view().isRunning()) speech_.speak(language_.toStdString());
    form_.retranslate();
    guide_.retranslate();
    emit languageChanged();
}

}  // namespace passung::window
