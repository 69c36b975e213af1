#pragma once

#include <QtCore/QObject>
#include <QtCore/QVariant>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "study/run/machine/loop_check.h"
#include "study/run/machine/stability_report.h"
#include "study/run/machine/stage_cost.h"
#include "ui/presenter/study_details.h"
#include "ui/window/desk.h"
#include "ui/window/studies.h"
#include "ui/window/worker.h"

namespace passung::window {

/// A condition's wall as its device feels it.
struct ConditionWall {
    std::string condition, device;
    double displayed = 0.0, most = 0.0;  // stiffness; the device's "max", 0: not known [N/m]
    run::WallBounds bounds;
    bool modelled = false;  // the mechanism is known
};

/// Stages that some conditions share.
struct StageTable {
    std::vector<std::string> conditions;
    std::vector<run::StageCost> stages;
};

/// Everything that takes a moment to find out about the chosen study, for QML; found out in a thread of its own.
class StudyModel : public QObject {
    Q_OBJECT
    Q_PROPERTY(QVariantList issues READ issues NOTIFY changed)  // problems, then warnings
    Q_PROPERTY(QVariantMap design READ design NOTIFY changed)
    Q_PROPERTY(QVariantList walls READ walls NOTIFY changed)
    Q_PROPERTY(QString told READ told NOTIFY changed)  // why there is less than this
    Q_PROPERTY(QVariantMap stages READ stages NOTIFY stagesChanged)
    Q_PROPERTY(QVariantMap accuracy READ accuracy NOTIFY changed)
    Q_PROPERTY(QVariantMap loop READ loop NOTIFY loopChanged)
    Q_PROPERTY(QVariantMap source READ source NOTIFY sourceChanged)  // the text that is shown

public:
    StudyModel(Desk& desk, Studies& studies);

    QVariantList issues() const;
    QVariantMap design() const;
    QVariantList walls() const;
    QString told() const { return told_; }
    QVariantMap stages() const;
    QVariantMap accuracy() const;
    QVariantMap loop() const;
    QVariantMap source() const;

    Q_INVOKABLE void measureStages();
    Q_INVOKABLE void checkLoop();
    /// Shows the file that issue `index` is in at its line, and puts FILE:LINE into the clipboard.
    Q_INVOKABLE void openIssue(int index);
    Q_INVOKABLE void openProtocol();
    void retranslate();

signals:
    void changed();
    void stagesChanged();
    void loopChanged();
    void sourceChanged();

private:
    struct Facts {
        presenter::StudyDetails details;
        std::vector<ConditionWall> walls;
        std::vector<presenter::AccuracyPoint> points;
        bool asks_for_accuracy = false;
    };
    static Result<std::shared_ptr<Facts>> findOut(const std::string& protocol, const std::string& database);
    void refresh();
    void show(const std::string& file, int line);

    Desk& desk_;
    Studies& studies_;
    std::shared_ptr<Facts> facts_;  // shared: through the event loop
    QString told_;
    std::vector<StageTable> stages_;
    QString stages_of_;  // protocol that they are of
    bool measuring_ = false, checking_ = false;
    std::optional<run::LoopCheck> loop_;
    QString source_file_, source_problem_;
    QStringList source_lines_;
    int source_line_ = 0;
    int asked_ = 0;
    Worker worker_, measurer_;  // last: what they call is there until they end
};

}  // namespace passung::window
