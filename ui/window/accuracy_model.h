#pragma once

#include <QtCore/QElapsedTimer>
#include <QtCore/QObject>
#include <QtCore/QVariant>
#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "study/run/operating_point.h"
#include "ui/presenter/tick_plot.h"
#include "ui/window/accuracy_words.h"
#include "ui/window/desk.h"
#include "ui/window/studies.h"
#include "ui/window/worker.h"

namespace passung::window {

/// What accuracy costs a tick of the chosen study, for QML: read from the file beside the study, or measured in a
/// thread of its own; kept while the program runs, and written into the study where a setting is chosen.
class AccuracyModel : public QObject {
    Q_OBJECT
    Q_PROPERTY(int condition READ condition WRITE setCondition NOTIFY changed)  // index into the plan's
    Q_PROPERTY(int error READ error WRITE setError NOTIFY changed)              // presenter::TickError
    Q_PROPERTY(int chosen READ chosen WRITE choose NOTIFY changed)              // point of the plot; -1: none
    Q_PROPERTY(QVariantMap front READ front NOTIFY changed)                     // empty: nothing was measured
    Q_PROPERTY(QVariantMap choice READ choice NOTIFY changed)                   // what is chosen, and what came of it
    Q_PROPERTY(QVariantMap work READ work NOTIFY workChanged)                   // how far measuring is

public:
    /// `effort`: of what is measured.
    AccuracyModel(Desk& desk, Studies& studies, const truth::TickEffort& effort);
    ~AccuracyModel() override;  // gives up what is measured

    int condition() const;
    void setCondition(int condition);
    int error() const { return static_cast<int>(error_); }
    void setError(int error);
    int chosen() const;
    void choose(int point);
    QVariantMap front() const;
    QVariantMap choice() const;
    QVariantMap work() const;

    Q_INVOKABLE void measure();
    Q_INVOKABLE void cancel();
    /// The next setting of the front: step 1 to slower, -1 to faster ones.
    Q_INVOKABLE void step(int step);
    /// Writes the chosen setting into the study.
    Q_INVOKABLE void use();
    void retranslate();

signals:
    void changed();
    void workChanged();

private:
    /// A condition's front, with the study as it was read for it.
    struct Measured {
        plan::StudyPlan plan;
        std::size_t condition = 0;
        run::TickFront front;
        std::optional<std::size_t> row = {};          // that is chosen
        std::optional<run::FrontOrigin> origin = {};  // of one that was read
    };
    using Shared = std::shared_ptr<Measured>;  // shared: through the event loop
    struct Told {
        std::optional<run::OperatingPoint> point = {};  // what was written, or why nothing was
        std::optional<WhyNoFront> why = {};             // nothing is measured
        std::string problem = {};                       // else
    };

    std::string path() const;
    Measured* shown() const;
    presenter::TickPlot plot(const Measured& measured) const;
    bool tell(const std::string& path, const run::FrontProgress& progress);
    void giveWay();
    void readStored();
    void tookStored(Result<std::vector<Shared>> read, const std::string& path);
    void took(Result<Shared> measured, const std::string& path, int condition);

    Desk& desk_;
    Studies& studies_;
    truth::TickEffort effort_;
    presenter::TickError error_ = presenter::TickError::Overlap;
    std::map<std::string, int> conditions_;                   // shown, by the study's file
    std::map<std::pair<std::string, int>, Shared> measured_;  // by file and condition
    std::map<std::string, Told> told_;                        // by file, of the last thing that was done
    std::set<std::string> read_;                              // files beside which it was looked for fronts
    std::string running_;                                     // file of the study that is measured; empty: none
    std::atomic<bool> cancelled_{false};
    double share_ = 0.0, cell_ = 0.0;
    std::optional<truth::TickSetting> setting_;  // that is measured
    bool using_ = false;
    QElapsedTimer since_;              // measuring began
    Worker worker_, writer_, reader_;  // last: what they call is there until they end
};

}  // namespace passung::window
