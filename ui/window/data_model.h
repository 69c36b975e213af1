#pragma once

#include <QtCore/QObject>
#include <QtCore/QVariant>
#include <atomic>
#include <climits>
#include <memory>
#include <string>

#include "analysis/report/report.h"
#include "ui/presenter/recorded.h"
#include "ui/window/desk.h"
#include "ui/window/replay_model.h"
#include "ui/window/studies.h"
#include "ui/window/worker.h"

namespace passung::window {

/// What the chosen study's databases hold, for QML: sessions, attempts, a quick look, export.
class DataModel : public QObject {
    Q_OBJECT
    Q_PROPERTY(int source READ source WRITE setSource NOTIFY changed)  // 0: the study's, 1: its try-outs, 2: `file`
    Q_PROPERTY(QString file READ file WRITE setFile NOTIFY changed)
    Q_PROPERTY(QString database READ database NOTIFY changed)
    Q_PROPERTY(bool there READ there NOTIFY changed)  // the database exists
    Q_PROPERTY(bool busy READ busy NOTIFY changed)
    Q_PROPERTY(QString told READ told NOTIFY changed)
    Q_PROPERTY(bool failed READ failed NOTIFY changed)
    Q_PROPERTY(QVariantList sessions READ sessions NOTIFY changed)
    Q_PROPERTY(QString session READ session WRITE setSession NOTIFY changed)  // id of the selected one
    Q_PROPERTY(QVariantList attempts READ attempts NOTIFY changed)            // of it
    Q_PROPERTY(QVariantList measures READ measures NOTIFY changed)
    Q_PROPERTY(int measure READ measure WRITE setMeasure NOTIFY changed)
    Q_PROPERTY(QStringList kinds READ kinds NOTIFY changed)
    Q_PROPERTY(int kind READ kind WRITE setKind NOTIFY changed)
    Q_PROPERTY(QVariantMap look READ look NOTIFY changed)
    Q_PROPERTY(bool exporting READ exporting NOTIFY exportChanged)
    Q_PROPERTY(double exported READ exported NOTIFY exportChanged)  // share
    Q_PROPERTY(bool reporting READ reporting NOTIFY exportChanged)  // what is being exported gets a report
    Q_PROPERTY(QString proposedFolder READ proposedFolder NOTIFY changed)
    Q_PROPERTY(QString lastFolder READ lastFolder NOTIFY exportChanged)  // of a finished export
    Q_PROPERTY(QString lastReport READ lastReport NOTIFY exportChanged)  // its page; empty: none

public:
    DataModel(Desk& desk, Studies& studies, ReplayModel& replay);
    ~DataModel() override { cancelled_ = true; }

    int source() const { return source_; }
    void setSource(int source);
    QString file() const { return file_; }
    void setFile(const QString& file);
    QString database() const;
    bool there() const { return recorded_ != nullptr; }
    bool busy() const { return worker_.busy(); }
    QString told() const { return told_; }
    bool failed() const { return failed_; }
    QVariantList sessions() const;
    QString session() const { return QString::fromStdString(session_); }
    void setSession(const QString& session);
    QVariantList attempts() const;
    QVariantList measures() const;
    int measure() const { return measure_; }
    void setMeasure(int measure);
    QStringList kinds() const;
    int kind() const { return kind_; }
    void setKind(int kind);
    QVariantMap look() const;
    bool exporting() const { return exporting_; }
    double exported() const { return exported_; }
    bool reporting() const { return exporting_ && reporting_; }
    QString proposedFolder() const;
    QString lastFolder() const { return last_folder_; }
    QString lastReport() const { return last_report_; }

    Q_INVOKABLE void refresh() { read(true); }
    /// Shows an attempt of the selected session once more.
    Q_INVOKABLE void showAgain(int attempt);
    Q_INVOKABLE void exportTo(const QString& folder, bool samples) { write(folder, samples, false); }
    /// An export with the planned analyses, which R computes where it is installed.
    Q_INVOKABLE void reportTo(const QString& folder, bool samples) { write(folder, samples, true); }
    Q_INVOKABLE void cancelExport() { cancelled_ = true; }
    void retranslate();

signals:
    void changed();
    void exportChanged();

private:
    void read(bool looks);
    void write(const QString& folder, bool samples, bool with_report);
    void tellWritten(const QString& folder, const Result<report::ReportOutcome>& outcome);

    Desk& desk_;
    Studies& studies_;
    ReplayModel& replay_;
    int source_ = 0;
    QString file_, told_, last_folder_, last_report_;
    bool failed_ = false, ran_ = false, exporting_ = false, reporting_ = false;
    std::int64_t ended_ = 0;  // attempts of the running session, which the page follows
    double exported_ = 0.0;
    std::atomic<bool> cancelled_{false};
    std::unique_ptr<presenter::Recorded> recorded_;
    std::string session_;
    std::int64_t again_ = 0;            // attempt that is shown again
    int measure_ = INT_MAX, kind_ = 0;  // until something is read: none
    std::string whole_;                 // database in which a look found no damage
    int asked_ = 0;                     // readings so far: an answer to an earlier one is old
    Worker worker_;                     // last: what it calls is there until it ends
};

}  // namespace passung::window
