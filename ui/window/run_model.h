#pragma once

#include <QtCore/QElapsedTimer>
#include <QtCore/QObject>
#include <QtCore/QVariant>

#include "ui/experimenter/trace_item.h"
#include "ui/window/desk.h"

namespace passung::window {

/// The experimenter's view state of a run for QML.
class RunModel : public QObject {
    Q_OBJECT
    Q_PROPERTY(bool known READ known NOTIFY changed)      // there is or was a session
    Q_PROPERTY(bool running READ running NOTIFY changed)  // it is not over
    Q_PROPERTY(QString tone READ tone NOTIFY changed)     // "rest", "go", "wait", "bad", "good": colour and sign
    Q_PROPERTY(QString line READ line NOTIFY changed)
    Q_PROPERTY(QString detail READ detail NOTIFY changed)
    Q_PROPERTY(QString study READ study NOTIFY changed)
    Q_PROPERTY(QString participant READ participant NOTIFY changed)
    Q_PROPERTY(double share READ share NOTIFY changed)
    Q_PROPERTY(QString answer READ answer NOTIFY changed)
    Q_PROPERTY(QString warnings READ warnings NOTIFY changed)  // of this run, a line each
    Q_PROPERTY(bool refused READ refused NOTIFY changed)
    Q_PROPERTY(double built READ built NOTIFY changed)  // share of models that are being built; below 0: none are
    Q_PROPERTY(bool displayGone READ displayGone NOTIFY changed)   // the participant sees nothing
    Q_PROPERTY(QString sound READ sound NOTIFY measured)           // of this trial; empty: it has none
    Q_PROPERTY(QVariantMap commands READ commands NOTIFY changed)  // by name: why not; empty: possible
    Q_PROPERTY(bool byHand READ byHand NOTIFY changed)             // the experimenter times the trial
    Q_PROPERTY(QVariantList rows READ rows NOTIFY rowsChanged)
    Q_PROPERTY(int currentRow READ currentRow NOTIFY rowsChanged)
    Q_PROPERTY(double seconds READ seconds NOTIFY measured)
    Q_PROPERTY(double force READ force NOTIFY measured)
    Q_PROPERTY(double depth READ depth NOTIFY measured)
    Q_PROPERTY(QString lamp READ lamp NOTIFY measured)  // "rest", "good", "wait", "bad"
    Q_PROPERTY(double rate READ rate NOTIFY measured)
    Q_PROPERTY(double typical READ typical NOTIFY measured)
    Q_PROPERTY(double longest READ longest NOTIFY measured)
    Q_PROPERTY(int missed READ missed NOTIFY measured)
    Q_PROPERTY(bool pictured READ pictured NOTIFY measured)    // the pictures are known
    Q_PROPERTY(double pictures READ pictures NOTIFY measured)  // a second
    Q_PROPERTY(double pictureAge READ pictureAge NOTIFY measured)
    Q_PROPERTY(QVariantList steps READ steps NOTIFY stepsChanged)  // of an assembly: "name", "word", "tone"
    Q_PROPERTY(QString quality READ quality NOTIFY changed)        // of the pictures; empty: not found yet

public:
    explicit RunModel(Desk& desk);

    bool known() const { return !view().is<presenter::state::Idle>(); }
    bool running() const { return view().isRunning(); }
    QString tone() const;
    QString line() const;
    QString detail() const;
    bool byHand() const { return view().brief.timed_by == plan::TimedBy::Experimenter && running(); }
    QString study() const { return QString::fromStdString(view().study); }
    QString participant() const { return QString::fromStdString(view().participant); }
    double share() const;
    QString answer() const;
    QString warnings() const;
    bool refused() const { return view().answered && !view().answered->answer.accepted; }
    double built() const { return view().built().value_or(-1.0); }
    bool displayGone() const { return known() && view().display != presenter::Display::Shown; }
    QString sound() const;
    QVariantMap commands() const;
    QVariantList rows() const;
    int currentRow() const { return static_cast<int>(view().number) - 1; }
    double seconds() const { return view().trial_s; }
    double force() const { return view().force_N; }
    double depth() const { return view().depth_mm; }
    QString lamp() const;
    double rate() const { return loop().rate_hz; }
    double typical() const { return loop().typical_us; }
    double longest() const { return loop().longest_us; }
    int missed() const { return static_cast<int>(loop().missed); }
    bool pictured() const { return view().pictures.has_value(); }
    double pictures() const { return view().pictures ? view().pictures->per_s : 0.0; }
    double pictureAge() const { return view().pictures ? view().pictures->age_ms : 0.0; }
    const QVariantList& steps() const { return steps_; }
    QString quality() const;

    /// `name`: one of session::kCommandNames.
    Q_INVOKABLE void command(const QString& name, const QString& text = {});
    /// Opens the participant's window again.
    Q_INVOKABLE void openDisplay() { desk_.openDisplay(); }
    Q_INVOKABLE void showTraces(passung::experimenter::TraceItem* force, passung::experimenter::TraceItem* depth);
    void retranslate();

signals:
    void changed();
    void rowsChanged();
    void measured();
    void stepsChanged();

private:
    QVariantList stepsNow() const;
    void lookAtSteps();
    const presenter::RunView& view() const { return desk_.run().view(); }
    presenter::LoopView loop() const { return view().loop.value_or(presenter::LoopView()); }

    Desk& desk_;
    std::int64_t rows_known_ = -1;
    std::size_t state_known_ = 0;  // its place among the states
    QVariantList steps_;
    QElapsedTimer since_measured_;
};

}  // namespace passung::window
