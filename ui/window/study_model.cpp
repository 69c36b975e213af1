#include "ui/window/study_model.h"

#include <QtGui/QClipboard>
#include <QtGui/QGuiApplication>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/base/digest.h"
#include "core/base/regular_file.h"
#include "study/run/files/builds.h"
#include "study/run/files/known_names.h"
#include "study/run/files/protocol_files.h"
#include "study/run/machine/auto_accuracy.h"
#include "study/store/read/store_reader.h"
#include "ui/window/participants_words.h"
#include "ui/window/registry_words.h"
#include "ui/window/study_words.h"
#include "ui/window/text.h"

namespace passung::window {

namespace {

QStringList texts(const std::vector<std::string>& all) {
    QStringList list;
    for (const auto& each : all) list.append(text(each));
    return list;
}

std::vector<ConditionWall> wallsOf(const plan::StudyPlan& plan) {
    std::vector<ConditionWall> walls;
    for (std::size_t i = 0; i < plan::plannedConditions(plan); ++i) {
        const plan::Condition& condition = plan.conditions[i];
        const DeviceDescription* device = run::deviceNamed(condition.device, run::knownDevices());
        if (device == nullptr || !condition.scene.display_wrench || condition.timed_by != plan::TimedBy::Program)
            continue;
        ConditionWall wall;
        wall.condition = condition.name;
        wall.device = device->label;
        wall.displayed = condition.scene.contact.stiffness;
        wall.most = device->stable_stiffness_N_per_m;
        if (device->mechanism) {
            const run::SceneWall felt = run::translationWall(*device, condition.scene);
            wall.displayed = felt.stiffness;
            wall.bounds = felt.bounds;
            wall.modelled = true;
        }
        walls.push_back(std::move(wall));
    }
    return walls;
}

Result<std::vector<StageTable>> measure(const std::string& protocol) {
    const auto plan = run::readProtocol(protocol);
    if (!plan) return plan.errors();
    const auto store = run::openBuilds();
    scene::PartCache cache(store.get());
    std::vector<StageTable> tables;
    for (const auto& conditions : run::costGroups(*plan)) {
        const auto scene = scene::buildScene(conditions.front()->scene, cache);
        if (!scene) return scene.errors();
        StageTable table{{}, run::measureTick(*scene).stages};
        for (const auto* condition : conditions) table.conditions.push_back(condition->name);
        tables.push_back(std::move(table));
    }
    return tables;
}

QVariantMap orderMap(const presenter::OrderLine& line, const presenter::StudyDetails& details) {
    QVariantList blocks;
    for (const auto& block : line.blocks) {
        QVariantList passes;
        for (const auto& pass : block.passes) {
            QVariantList trials;
            for (const auto& trial : pass.trials)
                trials.append(
                    QVariantMap{{"condition", static_cast<int>(trial.condition) + 1}, {"caught", trial.catch_trial}});
            passes.append(QVariantMap{{"times", pass.times}, {"trials", trials}});
        }
        blocks.append(QVariantMap{{"name", text(details.blocks[block.block].name)}, {"passes", passes}});
    }
    return {{"code", text(line.code)},
            {"group", text(line.group)},
            {"session", details.minutes.size() > 1 ? line.session : 0},
            {"trials", static_cast<int>(line.trials)},
            {"blocks", blocks}};
}

/// Powers of ten around all values, as exponents.
std::pair<int, int> decades(const std::vector<double>& values) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const int low = static_cast<int>(std::floor(std::log10(*least)));
    return {low, std::max(low + 1, static_cast<int>(std::ceil(std::log10(*most))))};
}

}  // namespace

StudyModel::StudyModel(Desk& desk, Studies& studies) : desk_(desk), studies_(studies) {
    connect(&studies_, &Studies::chosenChanged, this, [this] { refresh(); });
    connect(&desk_, &Desk::happened, this, [this] {
        emit stagesChanged();  // what may be measured now
        emit loopChanged();
    });
    refresh();
}

Result<std::shared_ptr<StudyModel::Facts>> StudyModel::findOut(const std::string& protocol,
                                                               const std::string& database) {
    const auto plan = run::readProtocol(protocol);
    if (!plan) return plan.errors();
    auto details = presenter::detailsOf(*plan, plan->participants);
    if (!details) return details.errors();
    auto facts = std::make_shared<Facts>();
    facts->details = *std::move(details);
    facts->walls = wallsOf(*plan);
    facts->asks_for_accuracy = run::asksForAccuracy(*plan);
    if (!std::filesystem::exists(database)) return facts;
    const auto reader = store::StoreReader::open(database);
    if (!reader) return reader.errors();
    const auto rows = reader->accuracy();
    if (!rows) return rows.errors();
    facts->points = presenter::accuracyPoints(*rows, sha256Hex(plan->source_text));
    return facts;
}

void StudyModel::refresh() {
    const presenter::StudyCard* card = studies_.card();
    facts_.reset();
    told_.clear();
    if (card != nullptr) openProtocol();
    if (card != nullptr && card->sound) {
        const int asked = ++asked_;
        worker_.run([protocol = card->path, database = studies_.database()] { return findOut(protocol, database); },
                    [this, asked](Result<std::shared_ptr<Facts>> facts) {
                        if (asked != asked_) return;
                        if (facts)
                            facts_ = *facts;
                        else
                            told_ = text(toString(facts.errors().front()));
                        emit changed();
                    });
    }
    emit changed();
    emit stagesChanged();
}

QVariantList StudyModel::issues() const {
    QVariantList all;
    const presenter::StudyCard* card = studies_.card();
    if (card == nullptr) return all;
    for (const Error& error : card->problems) {
        Error bare = error;  // its place stands beside it
        bare.file.clear();
        bare.line = bare.column = 0;
        const QString file = text(std::filesystem::path(error.file).filename().string());
        all.append(QVariantMap{
            {"text", text(toString(bare)).remove(QStringLiteral("error: "))},
            {"place", error.line > 0 ? QStringLiteral("%1:%2:%3").arg(file).arg(error.line).arg(error.column) : file},
            {"tone", "bad"}});
    }
    for (const auto& warning : card->warnings)
        all.append(QVariantMap{{"text", text(warning)}, {"place", QString()}, {"tone", "wait"}});
    return all;
}

QVariantMap StudyModel::design() const {
    if (!facts_) return {};
    const presenter::StudyDetails& details = facts_->details;
    QVariantList blocks, orders;
    for (const auto& block : details.blocks)
        blocks.append(QVariantMap{{"name", text(block.name)}, {"words", blockWords(block, details.minutes.size())}});
    for (const auto& order : details.orders) orders.append(orderMap(order, details));
    return {{"conditions", texts(details.conditions)},
            {"blocks", blocks},
            {"orders", orders},
            {"duration", durationLine(details.minutes)},
            {"balance", balanceLines(details.balance)}};
}

QVariantList StudyModel::walls() const {
    QVariantList all;
    if (!facts_) return all;
    for (const ConditionWall& wall : facts_->walls) {
        const bool stable =
            wall.modelled ? wall.displayed < wall.bounds.border : wall.most > 0.0 && wall.displayed <= wall.most;
        all.append(QVariantMap{{"condition", text(wall.condition)},
                               {"device", deviceWord(wall.device)},
                               {"stiffness", wall.displayed},
                               {"most", wall.most},
                               {"border", wall.bounds.border},
                               {"passive", wall.bounds.passive},
                               {"known", wall.modelled || wall.most > 0.0},
                               {"stable", stable}});
    }
    return all;
}

QVariantMap StudyModel::stages() const {
    const presenter::StudyCard* card = studies_.card();
    const bool mine = card != nullptr && stages_of_ == text(card->path);
    QVariantList tables;
    double whole = 0.0;
    for (const StageTable& table : stages_) {
        if (!mine) break;
        QVariantList rows;
        double sum = 0.0;
        for (const run::StageCost& stage : table.stages) {
            rows.append(QVariantMap{{"name", stageWord(stage.name)},
                                    {"reason", stageWord(stage.reason)},
                                    {"median", stage.median_us},
                                    {"p99", stage.p99_us}});
            sum += stage.median_us;
        }
        whole = std::max(whole, sum);
        tables.append(QVariantMap{{"conditions", texts(table.conditions).join(", ")}, {"rows", rows}, {"sum", sum}});
    }
    return {{"tables", tables},
            {"whole", whole},
            {"measuring", measuring_},
            {"why", card == nullptr || !card->sound  ? whyNotMeasure(WhyNotMeasure::NotSound)
                    : desk_.run().view().isRunning() ? whyNotMeasure(WhyNotMeasure::SessionRuns)
                    : measuring_ || checking_        ? whyNotMeasure(WhyNotMeasure::Measures)
                                                     : QString()}};
}

void StudyModel::measureStages() {
    if (!stages()["why"].toString().isEmpty()) return;
    measuring_ = true;
    measurer_.run([path = studies_.card()->path] { return measure(path); },
                  [this, of = text(studies_.card()->path)](Result<std::vector<StageTable>> tables) {
                      measuring_ = false;
                      if (tables) {
                          stages_ = *std::move(tables);
                          stages_of_ = of;
                      } else {
                          told_ = text(toString(tables.errors().front()));
                      }
                      emit changed();
                      emit stagesChanged();
                      emit loopChanged();
                  });
    emit stagesChanged();
    emit loopChanged();
}

QVariantMap StudyModel::accuracy() const {
    if (!facts_) return {};
    if (facts_->points.empty()) return {{"hint", accuracyHint(facts_->asks_for_accuracy)}};
    std::vector<double> times, errors;
    for (const auto& point : facts_->points) {
        times.push_back(point.time_us);
        errors.push_back(std::max(point.error_um, 1e-3));
        times.insert(times.end(), point.picked_for_us.begin(), point.picked_for_us.end());
    }
    QVariantList points;
    QStringList picked;
    for (const auto& point : facts_->points) {
        points.append(QVariantMap{{"x", std::log10(point.time_us)},
                                  {"y", std::log10(std::max(point.error_um, 1e-3))},
                                  {"mode", text(point.mode)},
                                  {"front", point.front},
                                  {"picked", !point.picked_for_us.empty()}});
        for (const double budget : point.picked_for_us) picked.append(pickLine(point, budget));
    }
    QVariantList budgets;
    for (const auto& point : facts_->points)
        for (const double budget : point.picked_for_us) budgets.append(std::log10(budget));
    const auto [x_low, x_high] = decades(times);
    const auto [y_low, y_high] = decades(errors);
    return {{"points", points}, {"budgets", budgets}, {"picked", picked}, {"xLow", x_low},
            {"xHigh", x_high},  {"yLow", y_low},      {"yHigh", y_high}};
}

QVariantMap StudyModel::loop() const {
    const bool runs = desk_.run().view().isRunning();
    QVariantMap map{{"checking", checking_},
                    {"known", loop_.has_value()},
                    {"tone", !loop_                                               ? "rest"
                             : loop_->fitness == run::LoopFitness::Studies        ? "good"
                             : loop_->fitness == run::LoopFitness::StudiesIfAlone ? "wait"
                                                                                  : "bad"},
                    {"why", runs                      ? whyNotMeasure(WhyNotMeasure::SessionRuns)
                            : checking_ || measuring_ ? whyNotMeasure(WhyNotMeasure::Measures)
                                                      : QString()}};
    if (!loop_) return map;
    map["p50"] = loop_->p50_us;
    map["p99"] = loop_->p99_us;
    map["p999"] = loop_->p999_us;
    map["most"] = loop_->max_us;
    map["missed"] = static_cast<int>(loop_->missed);
    map["ticks"] = static_cast<int>(loop_->ticks);
    map["verdict"] = loopVerdict(loop_->fitness);
    return map;
}

void StudyModel::checkLoop() {
    if (!loop()["why"].toString().isEmpty()) return;
    constexpr double kSeconds = 10.0;
    checking_ = true;
    measurer_.run([] { return Result<run::LoopCheck>(run::checkLoop(kSeconds)); },
                  [this](Result<run::LoopCheck> check) {
                      checking_ = false;
                      if (check) loop_ = *std::move(check);
                      emit loopChanged();
                      emit stagesChanged();
                  });
    emit loopChanged();
    emit stagesChanged();
}

void StudyModel::openIssue(int index) {
    const presenter::StudyCard* card = studies_.card();
    if (card == nullptr || index < 0 || index >= static_cast<int>(card->problems.size())) return;
    const Error& error = card->problems[static_cast<std::size_t>(index)];
    if (error.file.empty()) return;
    show(error.file, error.line);
    const QString place = text(error.file) + (error.line > 0 ? QStringLiteral(":%1").arg(error.line) : QString());
    QGuiApplication::clipboard()->setText(place);
}

void StudyModel::openProtocol() {
    if (studies_.card() != nullptr) show(studies_.card()->path, 0);
}

void StudyModel::show(const std::string& file, int line) {
    source_file_ = text(file);
    source_line_ = line;
    const auto read = readFile(file);
    source_problem_ = read ? QString() : text(toString(read.errors().front()));
    source_lines_ = read ? text(*read).split('\n') : QStringList();
    if (!source_lines_.isEmpty() && source_lines_.back().isEmpty()) source_lines_.removeLast();
    emit sourceChanged();
}

QVariantMap StudyModel::source() const {
    return {{"file", source_file_}, {"problem", source_problem_}, {"lines", source_lines_}, {"line", source_line_}};
}

void StudyModel::retranslate() {
    emit changed();
    emit stagesChanged();
    emit loopChanged();
}

}  // namespace passung::window
