#pragma once

#include <QtCore/QObject>
#include <QtCore/QSettings>
#include <QtCore/QTranslator>
#include <QtQml/QQmlApplicationEngine>
#include <QtQml/QQmlContext>
#include <QtQuick/QQuickWindow>
#include <memory>
#include <string>

#include "ui/window/accuracy_model.h"
#include "ui/window/cut_off.h"
#include "ui/window/data_model.h"
#include "ui/window/desk.h"
#include "ui/window/form_model.h"
#include "ui/window/guide.h"
#include "ui/window/look.h"
#include "ui/window/participants_model.h"
#include "ui/window/places.h"
#include "ui/window/quality_finder.h"
#include "ui/window/run_model.h"
#include "ui/window/screen.h"
#include "ui/window/screen_choice.h"
#include "ui/window/stop_path.h"
#include "ui/window/studies.h"
#include "ui/window/study_model.h"

namespace passung::window {

struct AppOptions {
    std::string protocols;            // folder of the studies
    std::string data;                 // folder for the databases of try-outs, and for what the windows remember
    QString language;                 // "de", "en"
    bool dark = true;                 // the experimenter's window; the participant's looks as its study says
    double text_scale = 1.0;          // likewise
    truth::TickEffort accuracy = {};  // of measuring what it costs
    std::optional<presenter::PictureQuality> quality = {};  // the participant's window draws so; none: as it is found
};

/// Both windows and everything behind them.
class App : public QObject {
    Q_OBJECT
    Q_PROPERTY(QString language READ language WRITE setLanguage NOTIFY languageChanged)
    Q_PROPERTY(QString page READ page WRITE setPage NOTIFY pageChanged)  // of the experimenter's window

public:
    explicit App(const AppOptions& options);
    ~App() override;

    QString language() const { return language_; }
    void setLanguage(const QString& language);

    QString page() const { return page_; }
    void setPage(const QString& page);

    Desk& desk() { return desk_; }
    Studies& studies() { return studies_; }
    ParticipantsModel& participants() { return participants_; }
    DataModel& records() { return records_; }
    ReplayModel& replay() { return replay_; }
    StudyModel& details() { return details_; }
    AccuracyModel& accuracy() { return accuracy_; }
    Look& look() { return look_; }
    Screen& screen() { return screen_; }
    FormModel& form() { return form_; }
    QQuickWindow* experimenter() const { return experimenter_; }
    QQuickWindow* participant() const { return participant_.get(); }

signals:
    void languageChanged();
    void pageChanged();

private:
    void makeParticipant();
    void dressParticipant();
    void watchGraphics();
    void keepPlaces();
    void remember();

    Look look_, participant_look_{true};
    Desk desk_;
    QSettings memory_;  // of what the next start finds as it was
    Studies studies_;
    ParticipantsModel participants_;
    CutOff cut_off_{desk_, studies_, participants_, memory_};
    ReplayModel replay_;
    DataModel records_;
    StudyModel details_;
    AccuracyModel accuracy_;
    RunModel run_;
    Speech speech_;
    FormModel form_;
    Guide guide_;
    Screen screen_, mirror_;
    QualityFinder quality_;
    StopPath stop_path_{desk_};
    ScreenChoice screen_choice_{desk_, screen_, memory_};
    QString language_, page_;
    QTranslator translator_;
    QQmlApplicationEngine engine_;  // after what the windows show: they go before it
    QQmlContext participant_context_{&engine_};
    QQuickWindow* experimenter_ = nullptr;
    std::unique_ptr<QQuickWindow> participant_;
    Places places_;
};

}  // namespace passung::window
