#include "ui/window/run_model.h"

#include "ui/presenter/step_view.h"
#include "ui/window/words.h"

namespace passung::window {

using presenter::OneOf;
namespace state = presenter::state;

namespace {

constexpr int kMeasuredEvery = 40;                      // [ms]
constexpr double kGoodRate = 995.0, kPoorRate = 970.0;  // [Hz]

/// The tone of each state.
struct Tone {
    const char* operator()(const OneOf<state::ToStart, state::Running, state::Consenting, state::ReadingPage,
                                       state::Answering> auto&) const {
        return "go";
    }
    const char* operator()(const OneOf<state::Ready, state::Paused, state::Resting> auto&) const { return "wait"; }
    const char* operator()(const OneOf<state::Stopped, state::Failed> auto&) const { return "bad"; }
    const char* operator()(const state::Complete&) const { return "good"; }
    const char* operator()(const OneOf<state::Idle, state::Opening, state::Preparing, state::AwaitingPicture,
                                       state::Between, state::Incomplete> auto&) const {
        return "rest";
    }
};

}  // namespace

RunModel::RunModel(Desk& desk) : desk_(desk) {
    since_measured_.start();
    connect(this, &RunModel::measured, this, &RunModel::lookAtSteps);
    connect(&desk_, &Desk::happened, this, [this] {
        emit changed();
        emit measured();
        if (view().rows_changed == rows_known_) return;
        rows_known_ = view().rows_changed;
        emit rowsChanged();
    });
    connect(&desk_, &Desk::frame, this, [this] {
        if (view().state.index() != state_known_) {
            state_known_ = view().state.index();
            emit changed();
        }
        if (since_measured_.elapsed() < kMeasuredEvery) return;
        since_measured_.restart();
        emit measured();
    });
}

QString RunModel::tone() const { return QString::fromLatin1(std::visit(Tone(), view().state)); }

QString RunModel::line() const { return stateLine(view()); }
QString RunModel::detail() const { return stateDetail(view()); }
QString RunModel::answer() const { return view().answered ? answerLine(*view().answered) : QString(); }

QString RunModel::warnings() const {
    QStringList lines;
    for (const std::string& warning : view().warnings) lines.push_back(warningLine(warning));
    return lines.join('\n');
}

QString RunModel::sound() const { return view().brief.sound ? soundLine(desk_.soundOutput()) : QString(); }

QString RunModel::quality() const { return view().quality ? qualityLine(*view().quality) : QString(); }

QVariantList RunModel::stepsNow() const {
    QVariantList all;
    const auto& scene = desk_.run().scene();
    if (!running() || !scene || !scene->picking) return all;
    const auto lines = presenter::stepLines(*scene->picking, desk_.run().poses().done());
    const auto states = presenter::stepStates(*scene->picking, desk_.run().poses());
    for (std::size_t i = 0; i < states.size(); ++i) {
        using measures::StepState;
        QString tone = QStringLiteral("rest");
        if (states[i] == StepState::Locked) tone = QStringLiteral("good");
        if (states[i] != StepState::Locked && states[i] != StepState::Idle) tone = QStringLiteral("go");
        all.append(QVariantMap{
            {"name", QString::fromStdString(lines[i].name)}, {"word", stepWord(states[i])}, {"tone", tone}});
    }
    return all;
}

void RunModel::lookAtSteps() {
    QVariantList now = stepsNow();
    if (now == steps_) return;
    steps_ = std::move(now);
    emit stepsChanged();
}

double RunModel::share() const {
    if (view().planned == 0) return 0.0;
    return static_cast<double>(view().finished) / static_cast<double>(view().planned);
}

QVariantMap RunModel::commands() const {
    QVariantMap all;
    for (std::size_t i = 0; i < std::size(session::kCommandNames); ++i) {
        const std::string_view name = session::kCommandNames[i];
        all.insert(QString::fromUtf8(name.data(), static_cast<qsizetype>(name.size())),
                   whyNot(view().why(static_cast<session::CommandKind>(i))));
    }
    return all;
}

QVariantList RunModel::rows() const {
    QVariantList all;
    for (const presenter::TrialRow& row : view().rows) {
        QString tone = QStringLiteral("rest");
        if (row.state == presenter::RowState::Success) tone = QStringLiteral("good");
        if (row.state == presenter::RowState::Running || row.state == presenter::RowState::Next)
            tone = QStringLiteral("go");
        if (row.state == presenter::RowState::Timeout) tone = QStringLiteral("wait");
        if (row.state == presenter::RowState::Failure || row.state == presenter::RowState::Aborted ||
            row.state == presenter::RowState::Invalid)
            tone = QStringLiteral("bad");
        all.append(QVariantMap{{"number", static_cast<int>(row.number)},
                               {"block", QString::fromStdString(row.block)},
                               {"phase", phaseWord(row.phase)},
                               {"condition", QString::fromStdString(row.condition)},
                               {"word", rowWord(row.state)},
                               {"sign", rowSign(row.state)},
                               {"tone", tone},
                               {"attempts", row.attempts},
                               {"seconds", row.time_s ? *row.time_s : -1.0},
                               {"remark", QString::fromStdString(row.remark)}});
    }
    return all;
}

QString RunModel::lamp() const {
    const std::optional<presenter::LoopView>& loop = view().loop;
    if (!loop || !loop->isWhole() || !running()) return QStringLiteral("rest");
    if (loop->rate_hz >= kGoodRate) return QStringLiteral("good");
    return loop->rate_hz >= kPoorRate ? QStringLiteral("wait") : QStringLiteral("bad");
}

void RunModel::command(const QString& name, const QString& text) {
    const auto kind = session::commandNamed(name.toStdString());
    if (kind == session::CommandKind::Start || kind == session::CommandKind::Continue) openDisplay();
    if (kind) desk_.command({.kind = *kind, .text = text.trimmed().toStdString()});
}

void RunModel::showTraces(experimenter::TraceItem* force, experimenter::TraceItem* depth) {
    force->show(desk_.run().force());
    depth->show(desk_.run().depth());
}

void RunModel::retranslate() {
    emit changed();
    emit rowsChanged();
    lookAtSteps();
}

}  // namespace passung::window
