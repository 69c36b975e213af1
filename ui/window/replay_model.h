#pragma once

#include <QtCore/QElapsedTimer>
#include <QtCore/QTimer>
#include <memory>
#include <string>

#include "study/run/files/builds.h"
#include "ui/experimenter/trace_item.h"
#include "ui/presenter/playback.h"
#include "ui/window/scene_model.h"
#include "ui/window/worker.h"

namespace passung::window {

/// A recorded attempt that is shown once more, for QML.
class ReplayModel : public SceneModel {
    Q_OBJECT
    Q_PROPERTY(bool open READ isOpen NOTIFY opened)
    Q_PROPERTY(bool there READ there NOTIFY opened)  // it is read
    Q_PROPERTY(QString title READ title NOTIFY opened)
    Q_PROPERTY(QString told READ told NOTIFY opened)  // why there is nothing to show
    Q_PROPERTY(bool drawsProxy READ drawsProxy NOTIFY opened)
    Q_PROPERTY(double length READ length NOTIFY opened)
    Q_PROPERTY(double go READ go NOTIFY opened)
    Q_PROPERTY(double time READ time WRITE seek NOTIFY frame)
    Q_PROPERTY(bool plays READ plays WRITE play NOTIFY playsChanged)
    Q_PROPERTY(double speed READ speed WRITE setSpeed NOTIFY playsChanged)
    Q_PROPERTY(double force READ force NOTIFY frame)
    Q_PROPERTY(double depth READ depth NOTIFY frame)
    Q_PROPERTY(double overlap READ overlap NOTIFY frame)

public:
    ReplayModel();

    bool isOpen() const { return open_; }
    bool there() const { return playback_ != nullptr; }
    QString title() const { return title_; }
    QString told() const { return told_; }
    bool drawsProxy() const;
    double length() const { return playback_ ? playback_->length() : 0.0; }
    double go() const { return playback_ ? playback_->go() : 0.0; }
    double time() const { return playback_ ? playback_->time() : 0.0; }
    void seek(double time);
    bool plays() const { return playback_ && playback_->plays(); }
    void play(bool plays);
    double speed() const { return playback_ ? playback_->speed() : 1.0; }
    void setSpeed(double speed);
    double force() const;
    double depth() const;
    double overlap() const;

    /// `meshes`: folder that the protocol's mesh paths start from; empty: here, else beside the database.
    void show(const std::string& database, const std::string& meshes, qlonglong attempt, const QString& title);
    void setTitle(const QString& title);
    Q_INVOKABLE void close();
    Q_INVOKABLE void showTraces(passung::experimenter::TraceItem* force, passung::experimenter::TraceItem* depth,
                                passung::experimenter::TraceItem* overlap);

signals:
    void opened();
    void playsChanged();

private:
    void refresh();

    std::unique_ptr<presenter::Playback> playback_;
    std::unique_ptr<run::Builds> builds_ = run::openBuilds();  // both of the worker's thread alone
    presenter::SceneArtist artist_{builds_.get()};
    QString title_, told_;
    bool open_ = false;
    int asked_ = 0;
    QTimer timer_;
    QElapsedTimer since_;
    Worker worker_;  // last: what it calls is there until it ends
};

}  // namespace passung::window
