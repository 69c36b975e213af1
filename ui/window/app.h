#pragma once

#include <QtCore/QObject>
#include <QtCore/QTranslator>
#include <QtQml/QQmlApplicationEngine>
#include <QtQuick/QQuickWindow>
#include <string>

#include "ui/window/desk.h"
#include "ui/window/look.h"
#include "ui/window/places.h"
#include "ui/window/run_model.h"
#include "ui/window/screen.h"
#include "ui/window/studies.h"

namespace passung::window {

struct AppOptions {
    std::string protocols;  // folder of the studies
    std::string data;       // folder for the databases of try-outs, and for what the windows remember
    QString language;       // "de", "en"
    bool dark = true;
    double text_scale = 1.0;
};

/// Both windows and everything behind them.
class App : public QObject {
    Q_OBJECT
    Q_PROPERTY(QString language READ language WRITE setLanguage NOTIFY languageChanged)

public:
    explicit App(const AppOptions& options);
    ~App() override;

    QString language() const { return language_; }
    void setLanguage(const QString& language);

    Desk& desk() { return desk_; }
    Look& look() { return look_; }
    Screen& screen() { return screen_; }
    QQuickWindow* experimenter() const { return experimenter_; }
    QQuickWindow* participant() const { return participant_; }

signals:
    void languageChanged();

private:
    void watchGraphics();
    void placeParticipant();
    void keepPlaces();

    Look look_;
    Desk desk_;
    Studies studies_;
    RunModel run_;
    Screen screen_, mirror_;
    QString language_;
    QTranslator translator_;
    QQmlApplicationEngine engine_;  // last: the windows go before what they show
    QQuickWindow* experimenter_ = nullptr;
    QQuickWindow* participant_ = nullptr;
    Places places_;
};

}  // namespace passung::window
