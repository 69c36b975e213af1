#pragma once

#include <QtCore/QObject>
#include <QtCore/QVariant>
#include <functional>
#include <optional>

#include "study/plan/study_plan.h"
#include "study/store/people/participant_records.h"
#include "ui/presenter/leaving.h"
#include "ui/presenter/participant_access.h"
#include "ui/presenter/participants.h"
#include "ui/window/desk.h"
#include "ui/window/studies.h"
#include "ui/window/worker.h"

namespace passung::window {

/// Who takes part in the chosen study, for QML. The database is read and written in a thread of its own.
class ParticipantsModel : public QObject {
    Q_OBJECT
    Q_PROPERTY(bool busy READ busy NOTIFY changed)
    Q_PROPERTY(bool known READ known NOTIFY changed)  // the list is there
    Q_PROPERTY(QString database READ database NOTIFY changed)
    Q_PROPERTY(QString told READ told NOTIFY changed)  // the answer to the last action
    Q_PROPERTY(bool failed READ failed NOTIFY changed)
    Q_PROPERTY(QStringList clauses READ clauses NOTIFY changed)
    Q_PROPERTY(QVariantList people READ people NOTIFY changed)
    Q_PROPERTY(QVariantMap person READ person NOTIFY changed)  // the selected one
    Q_PROPERTY(QString selected READ selected WRITE select NOTIFY changed)
    Q_PROPERTY(QVariantList places READ places NOTIFY changed)
    Q_PROPERTY(QStringList balance READ balance NOTIFY changed)
    Q_PROPERTY(QVariantMap leaving READ leaving NOTIFY changed)
    Q_PROPERTY(QString experimenter MEMBER experimenter_ NOTIFY experimenterChanged)

public:
    ParticipantsModel(Desk& desk, Studies& studies);

    bool busy() const { return worker_.busy(); }
    bool known() const { return participants_.has_value(); }
    QString database() const;
    QString told() const { return told_; }
    bool failed() const { return failed_; }
    QStringList clauses() const;
    QVariantList people() const;
    QVariantMap person() const;
    QString selected() const { return QString::fromStdString(selected_); }
    void select(const QString& code);
    QVariantList places() const;
    QStringList balance() const;
    QVariantMap leaving() const;
    QString experimenter() const { return experimenter_; }

    Q_INVOKABLE void refresh();
    Q_INVOKABLE QString proposedCode(bool pilot) const;
    Q_INVOKABLE QString whyNotEnrol(const QString& code, bool pilot) const;
    Q_INVOKABLE void enrol(const QString& code, bool pilot);
    /// Begins the selected participant's next session, or goes on with their last; it waits for Start. False: it may
    /// not be now. `language`: that they are spoken to in, where the study's texts have it.
    Q_INVOKABLE bool start(bool resume, const QString& language);
    /// `decision`: "yes", "no", "withdrawn", as the person said or signed.
    Q_INVOKABLE void decide(int clause, const QString& decision);
    Q_INVOKABLE QString whyNotReadmit(const QString& reason) const;
    Q_INVOKABLE void readmit(const QString& reason);

    Q_INVOKABLE void openLeaving();
    Q_INVOKABLE void closeLeaving();
    Q_INVOKABLE QString whyNotChoose(int scope, const QString& reason) const;
    Q_INVOKABLE void chooseLeaving(int scope, const QString& reason);
    Q_INVOKABLE void backLeaving();
    Q_INVOKABLE QString whyNotConfirm(const QString& typed) const;
    Q_INVOKABLE void confirmLeaving(const QString& typed, bool backupToo);

    void retranslate();

signals:
    void changed();
    void began(const QString& study, const QString& code);  // a session; the study's file
    void experimenterChanged();

private:
    bool sessionRuns() const { return desk_.run().view().isRunning(); }
    const presenter::ParticipantEntry* person_() const;
    std::string by() const;
    using Work = std::function<Result<Done>(store::Store&, store::ParticipantRecords&, const plan::StudyPlan&)>;
    void act(const Work& work, const QString& done);
    void tell(const Result<Done>& came, const QString& done);

    Desk& desk_;
    Studies& studies_;
    std::optional<presenter::Participants> participants_;
    presenter::LeavingDialog dialog_;
    std::string selected_;
    QString told_, experimenter_;
    bool failed_ = false, ran_ = false;
    int asked_ = 0;  // readings so far: an answer to an earlier one is old
    Worker worker_;  // last: what it calls is there until it ends
};

}  // namespace passung::window
