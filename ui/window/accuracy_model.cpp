#include "ui/window/accuracy_model.h"

#include <cmath>

#include "core/scene/contact_geometry.h"
#include "study/run/files/builds.h"
#include "study/run/files/protocol_files.h"
#include "ui/window/study_words.h"
#include "ui/window/text.h"

namespace passung::window {

namespace {

constexpr double kLeastNews = 0.002;  // of the work: less is not told again
constexpr double kKnownShare = 0.03;  // of the work: from there on it is told how long the rest takes

QVariantMap axisMap(const presenter::LogAxis& axis) {
    QVariantList ticks;
    for (const double tick : axis.ticks)
        ticks.append(QVariantMap{{"at", axis.shareOf(tick)}, {"text", QString::number(tick, 'g', 3)}});
    return {{"ticks", ticks}};
}

QVariantMap pointMap(const presenter::TickPlot& plot, const presenter::PlotPoint& point, const run::TickFront& front) {
    const truth::PathCost& row = front.measured.rows[point.row];
    const truth::TickSetting& setting = row.setting;
    const double cell = run::cellOf(front, setting);
    return {{"method", QString::fromLatin1(scene::methodName(setting.method))},
            {"geometry", QString::fromLatin1(scene::geometryName(setting.geometry))},
            {"details", detailWords(setting, cell)},
            {"words", settingWords(setting, cell)},
            {"time", numberWord(point.time)},
            {"error", numberWord(point.error)},
            {"xLow", plot.time.shareOf(point.time_low)},
            {"x", plot.time.shareOf(point.time)},
            {"yLow", plot.error.shareOf(point.error_low)},
            {"y", plot.error.shareOf(point.error)},
            {"front", point.front},
            {"inStudy", point.in_study}};
}

}  // namespace

AccuracyModel::AccuracyModel(Desk& desk, Studies& studies, const truth::TickEffort& effort)
    : desk_(desk), studies_(studies), effort_(effort) {
    connect(&studies_, &Studies::chosenChanged, this, [this] {
        readStored();
        emit changed();
        emit workChanged();
    });
    connect(&desk_, &Desk::opened, this, &AccuracyModel::giveWay);
    connect(&desk_, &Desk::happened, this, [this] {
        emit changed();
        emit workChanged();  // what may be measured now
    });
    readStored();  // of the study that was chosen before this was here
}

/// A session has the machine for itself.
void AccuracyModel::giveWay() {
    if (running_.empty() || cancelled_) return;
    told_[running_] = {.why = WhyNoFront::SessionBegan};
    cancel();
}

AccuracyModel::~AccuracyModel() { cancelled_ = true; }

/// What was measured for the study before, once.
void AccuracyModel::readStored() {
    const std::string file = path();
    if (file.empty() || !read_.insert(file).second) return;
    reader_.run(
        [file]() -> Result<std::vector<Shared>> {
            const auto stored = run::readFronts(file);
            if (!stored) return stored.errors();
            std::vector<Shared> found;
            if (!*stored) return found;
            const auto plan = run::readProtocol(file);
            if (!plan) return found;  // the page on the study says what is wrong with it
            for (std::size_t i = 0; i < plan->conditions.size(); ++i)
                if (auto front = run::frontOf(**stored, plan->conditions[i]))
                    found.push_back(std::make_shared<Measured>(Measured{*plan, i, *std::move(front), std::nullopt,
                                                                        run::originOf(**stored, plan->conditions[i])}));
            return found;
        },
        [this, file](Result<std::vector<Shared>> read) { tookStored(std::move(read), file); });
}

void AccuracyModel::tookStored(Result<std::vector<Shared>> read, const std::string& path) {
    if (!read) {
        told_[path] = {.problem = toString(read.errors().front())};
    } else {
        for (const Shared& stored : *read) {
            const int condition = static_cast<int>(stored->condition);
            measured_.insert({{path, condition}, stored});  // what was measured meanwhile stays
            conditions_.insert({path, condition});          // the first is shown, unless somebody chose already
        }
    }
    emit changed();
}

std::string AccuracyModel::path() const { return studies_.card() != nullptr ? studies_.card()->path : std::string(); }

int AccuracyModel::condition() const {
    const auto known = conditions_.find(path());
    return known == conditions_.end() ? 0 : known->second;
}

void AccuracyModel::setCondition(int condition) {
    if (condition < 0 || condition == this->condition()) return;
    conditions_[path()] = condition;
    told_.erase(path());
    emit changed();
}

void AccuracyModel::setError(int error) {
    error_ = error == 0 ? presenter::TickError::Overlap : presenter::TickError::Force;
    emit changed();
}

AccuracyModel::Measured* AccuracyModel::shown() const {
    const auto known = measured_.find({path(), condition()});
    return known == measured_.end() ? nullptr : known->second.get();
}

presenter::TickPlot AccuracyModel::plot(const Measured& measured) const {
    return presenter::tickPlot(measured.front, error_, measured.plan.conditions[measured.condition].scene);
}

int AccuracyModel::chosen() const {
    const Measured* measured = shown();
    if (measured == nullptr || !measured->row) return -1;
    const presenter::TickPlot drawn = plot(*measured);
    for (std::size_t i = 0; i < drawn.points.size(); ++i)
        if (drawn.points[i].row == *measured->row) return static_cast<int>(i);
    return -1;
}

void AccuracyModel::choose(int point) {
    Measured* measured = shown();
    if (measured == nullptr || point == chosen()) return;
    const presenter::TickPlot drawn = plot(*measured);
    measured->row.reset();
    if (point >= 0 && point < static_cast<int>(drawn.points.size()))
        measured->row = drawn.points[static_cast<std::size_t>(point)].row;
    told_.erase(path());
    emit changed();
}

void AccuracyModel::step(int step) {
    const Measured* measured = shown();
    if (measured == nullptr) return;
    const int from = chosen();
    const auto next = presenter::nextOnFront(
        plot(*measured), from < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(from)), step < 0 ? -1 : 1);
    if (next) choose(static_cast<int>(*next));
}

QVariantMap AccuracyModel::front() const {
    const Measured* measured = shown();
    if (measured == nullptr) return {};
    const presenter::TickPlot drawn = plot(*measured);
    QVariantList points;
    for (const presenter::PlotPoint& point : drawn.points) points.append(pointMap(drawn, point, measured->front));
    return {{"points", points},
            {"time", axisMap(drawn.time)},
            {"error", axisMap(drawn.error)},
            {"path", pathWords(measured->front)},
            {"origin", measured->origin ? originWords(*measured->origin) : QString()},
            {"elsewhere", measured->origin && (measured->origin->elsewhere || measured->origin->outdated)},
            {"none", points.isEmpty() ? noErrorWords(error_) : QString()}};
}

QVariantMap AccuracyModel::choice() const {
    const Measured* measured = shown();
    QString why;
    if (measured == nullptr || !measured->row)
        why = whyNotUse(WhyNotUse::NothingChosen);
    else if (desk_.run().view().isRunning())
        why = whyNotMeasure(WhyNotMeasure::SessionRuns);
    else if (using_)
        why = whyNotUse(WhyNotUse::Writes);
    QVariantMap map{{"why", why}, {"words", QString()}, {"told", QString()}, {"good", false}};
    if (measured != nullptr && measured->row) {
        const truth::PathCost& row = measured->front.measured.rows[*measured->row];
        map["words"] = costWords(row, run::cellOf(measured->front, row.setting));
    }
    const auto told = told_.find(path());
    if (told == told_.end()) return map;
    const auto& [point, why_none, problem] = told->second;
    map["told"] = point ? outcomeWords(*point) : why_none ? noFrontWords(*why_none) : text(problem);
    map["good"] = point && (point->outcome == run::OperatingPoint::Outcome::Written ||
                            point->outcome == run::OperatingPoint::Outcome::SaidAlready);
    return map;
}

QVariantMap AccuracyModel::work() const {
    const presenter::StudyCard* card = studies_.card();
    const bool runs = !running_.empty();
    return {{"measuring", runs},
            {"mine", runs && running_ == path()},
            {"cancelling", runs && cancelled_.load()},
            {"share", share_},
            {"what", setting_ ? settingWords(*setting_, cell_) : pathWord()},
            {"left", runs && share_ > kKnownShare
                         ? leftWords(1e-3 * static_cast<double>(since_.elapsed()) * (1.0 - share_) / share_)
                         : QString()},
            {"why", card == nullptr || !card->sound  ? whyNotMeasure(WhyNotMeasure::NotSound)
                    : desk_.run().view().isRunning() ? whyNotMeasure(WhyNotMeasure::SessionRuns)
                    : runs                           ? whyNotMeasure(WhyNotMeasure::Measures)
                                                     : QString()}};
}

/// In the thread that measures.
bool AccuracyModel::tell(const std::string& path, const run::FrontProgress& progress) {
    const auto setting = progress.setting != nullptr ? std::optional(*progress.setting) : std::nullopt;
    QMetaObject::invokeMethod(
        this,
        [this, path, setting, cell = progress.cell, share = progress.share] {
            if (running_ != path) return;
            setting_ = setting;
            cell_ = cell;
            share_ = share;
            emit workChanged();
        },
        Qt::QueuedConnection);
    return !cancelled_;
}

void AccuracyModel::measure() {
    if (!work()["why"].toString().isEmpty()) return;
    const std::string file = path();
    const int condition = this->condition();
    running_ = file;
    cancelled_ = false;
    share_ = 0.0;
    since_.start();
    setting_.reset();
    told_.erase(file);
    worker_.run(
        [this, file, condition]() -> Result<Shared> {
            auto plan = run::readProtocol(file);
            if (!plan) return plan.errors();
            const auto index = static_cast<std::size_t>(condition);
            if (index >= plan->conditions.size()) return Error{.message = "has no such condition", .file = file};
            const auto builds = run::openBuilds();
            if (plan->conditions[index].timed_by != plan::TimedBy::Program) return Shared();
            double told = -1.0;
            const truth::TickSetting* last = nullptr;
            const auto watch = [&](const run::FrontProgress& progress) {
                if (progress.setting == last && std::abs(progress.share - told) < kLeastNews) return !cancelled_;
                last = progress.setting;
                told = progress.share;
                return tell(file, progress);
            };
            auto front = run::measureFront(plan->conditions[index], effort_, watch, builds.get());
            if (!front) return front.errors();
            return std::make_shared<Measured>(Measured{*std::move(plan), index, *std::move(front)});
        },
        [this, file, condition](Result<Shared> measured) { took(std::move(measured), file, condition); });
    emit workChanged();
    emit changed();
}

void AccuracyModel::took(Result<Shared> measured, const std::string& path, int condition) {
    running_.clear();
    if (measured && *measured == nullptr)
        told_[path] = {.why = WhyNoFront::RealParts};
    else if (measured)
        measured_[{path, condition}] = *std::move(measured);
    else if (!cancelled_)
        told_[path] = {.problem = toString(measured.errors().front())};
    emit workChanged();
    emit changed();
}

void AccuracyModel::cancel() {
    if (running_.empty()) return;
    cancelled_ = true;
    emit workChanged();
}

void AccuracyModel::use() {
    if (!choice()["why"].toString().isEmpty()) return;
    const Shared measured = measured_.at({path(), condition()});
    using_ = true;
    writer_.run(
        [measured, setting = measured->front.measured.rows[*measured->row].setting, database = studies_.database()] {
            return Result<run::OperatingPoint>(
                run::useSetting(measured->plan, measured->condition, measured->front, setting, database));
        },
        [this, measured, file = path()](Result<run::OperatingPoint> point) {
            using_ = false;
            if (point && point->plan) measured->plan = *point->plan;
            const bool written = point && point->outcome == run::OperatingPoint::Outcome::Written;
            told_[file] = point ? Told{.point = *std::move(point)} : Told{.problem = toString(point.errors().front())};
            if (written)
                studies_.reload();  // tells of a change itself
            else
                emit changed();
        });
    emit changed();
}

void AccuracyModel::retranslate() {
    emit changed();
    emit workChanged();
}

}  // namespace passung::window
