#include "ui/window/replay_model.h"

#include <algorithm>

#include "study/run/files/stored_plans.h"
#include "study/store/read/store_reader.h"
#include "ui/presenter/participant.h"

namespace passung::window {

namespace {

constexpr int kReplayFrame = 16;  // [ms]
constexpr auto kColumns = static_cast<std::size_t>(presenter::Trace::kSeconds / presenter::Trace::kStretch);

using Read = std::shared_ptr<presenter::Playback>;  // shared: through the event loop

Result<Read> readFrom(const std::string& database, const std::string& meshes, std::int64_t id,
                      presenter::SceneArtist& artist) {
    const auto reader = store::StoreReader::open(database, store::Damaged::LeftOut);
    if (!reader) return reader.errors();
    const auto attempt = reader->attempt(id);
    if (!attempt) return attempt.errors();
    auto records = reader->records(id);
    if (!records) return records.errors();
    if (records->empty()) return Error{.message = "no tick of this attempt was recorded", .file = database};
    run::StoredPlans plans(*reader, meshes);
    const auto plan = plans.plan(attempt->protocol_sha256);
    if (!plan) return plan.errors();
    const auto& conditions = (*plan)->conditions;
    const auto condition = std::find_if(conditions.begin(), conditions.end(),
                                        [&](const auto& c) { return c.name == attempt->presented_condition; });
    if (condition == conditions.end())
        return Error{.message = "the stored protocol has no such condition",
                     .key = "condition",
                     .value = attempt->presented_condition};
    auto scene = artist.draw(*condition, (*plan)->view);
    if (!scene) return scene.errors();
    std::vector<std::vector<TickRecord>> others;
    for (std::size_t hand = 1; hand < condition->scene.handCount(); ++hand) {
        auto other = reader->records(id, hand);
        if (!other) return other.errors();
        others.push_back(*std::move(other));
    }
    return std::make_shared<presenter::Playback>(*std::move(records), *std::move(scene), std::move(others));
}

}  // namespace

ReplayModel::ReplayModel() {
    timer_.setTimerType(Qt::PreciseTimer);
    timer_.setInterval(kReplayFrame);
    connect(&timer_, &QTimer::timeout, this, [this] {
        if (!playback_ || !playback_->pass(1e-3 * static_cast<double>(since_.restart()))) return;
        refresh();
        if (!playback_->plays()) play(false);
    });
}

void ReplayModel::show(const std::string& database, const std::string& meshes, qlonglong attempt,
                       const QString& title) {
    close();
    open_ = true;
    title_ = title;
    const int asked = ++asked_;
    worker_.run([this, database, meshes, attempt] { return readFrom(database, meshes, attempt, artist_); },
                [this, asked](Result<Read> read) {
                    if (asked != asked_) return;
                    if (read) {
                        playback_ = std::make_unique<presenter::Playback>(std::move(**read));
                        SceneModel::show(*playback_->scene());
                        refresh();
                    } else {
                        told_ = QString::fromStdString(toString(read.errors().front()));
                    }
                    emit opened();
                    emit playsChanged();
                });
    emit opened();
}

void ReplayModel::setTitle(const QString& title) {
    title_ = title;
    emit opened();
}

void ReplayModel::close() {
    ++asked_;
    timer_.stop();
    playback_.reset();
    open_ = false;
    title_.clear();
    told_.clear();
    emit playsChanged();
    emit opened();
}

bool ReplayModel::drawsProxy() const { return playback_ && playback_->scene()->shown == plan::ShownPose::Proxy; }

void ReplayModel::refresh() {
    SceneModel::show(
        presenter::playbackView(*playback_->scene(), playback_->record(), playback_->others(), &playback_->poses()));
}

void ReplayModel::seek(double time) {
    if (!playback_ || time == playback_->time()) return;
    playback_->seek(time);
    refresh();
}

void ReplayModel::play(bool plays) {
    if (!playback_) return;
    playback_->play(plays);
    since_.restart();
    if (plays)
        timer_.start();
    else
        timer_.stop();
    refresh();
    emit playsChanged();
}

void ReplayModel::setSpeed(double speed) {
    if (!playback_) return;
    playback_->setSpeed(speed);
    emit playsChanged();
}

double ReplayModel::force() const { return playback_ ? presenter::forceOf(playback_->record()) : 0.0; }
double ReplayModel::depth() const {
    return playback_ ? 1e3 * static_cast<double>(playback_->record().hand_depth_m) : 0.0;
}
double ReplayModel::overlap() const {
    return playback_ ? 1e3 * static_cast<double>(playback_->record().proxy_depth_m) : 0.0;
}

void ReplayModel::showTraces(experimenter::TraceItem* force, experimenter::TraceItem* depth,
                             experimenter::TraceItem* overlap) {
    if (!playback_) return;
    force->show(playback_->forces(kColumns));
    depth->show(playback_->depths(kColumns));
    overlap->show(playback_->overlaps(kColumns));
}

}  // namespace passung::window
