#include "ui/window/studies.h"

#include <cmath>

#include "study/protocol/protocol_reader.h"
#include "ui/app/run_study.h"

namespace passung::window {

namespace {

QString text(const std::string& s) { return QString::fromStdString(s); }

QVariantMap cardMap(const presenter::StudyCard& card) {
    QVariantList factors, problems, warnings, questionnaires;
    for (const auto& factor : card.factors) {
        QStringList levels;
        for (const auto& level : factor.levels) levels.append(text(level));
        const QString unit = factor.unit.empty() ? QString() : QStringLiteral(" [%1]").arg(text(factor.unit));
        factors.append(QVariantMap{{"name", text(factor.name) + unit}, {"levels", levels}});
    }
    for (const Error& error : card.problems) problems.append(text(toString(error)));
    for (const auto& warning : card.warnings) warnings.append(text(warning));
    for (const auto& questionnaire : card.questionnaires) questionnaires.append(text(questionnaire));
    return {{"path", text(card.path)},
            {"name", text(card.name)},
            {"version", text(card.version)},
            {"title", text(card.title)},
            {"sound", card.sound},
            {"problems", problems},
            {"warnings", warnings},
            {"factors", factors},
            {"questionnaires", questionnaires},
            {"conditions", static_cast<int>(card.conditions)},
            {"trials", static_cast<int>(card.trials)},
            {"sessions", card.sessions},
            {"minutes", static_cast<int>(std::ceil(card.most_minutes))},
            {"participants", card.participants},
            {"device", text(card.device)}};
}

}  // namespace

Studies::Studies(Desk& desk, const std::string& folder) : desk_(desk) {
    for (const std::string& file : presenter::studyFilesBelow(folder))
        cards_.push_back(presenter::cardOf(
            file, protocol::readProtocol(file, app::knownDevices(), app::knownMeasures()), app::knownDevices()));
}

QVariantList Studies::cards() const {
    QVariantList all;
    for (const auto& card : cards_) all.append(cardMap(card));
    return all;
}

void Studies::tryOut(int card, bool simulated) {
    const auto& path = cards_.at(static_cast<std::size_t>(card)).path;
    const auto plan = protocol::readProtocol(path, app::knownDevices(), app::knownMeasures());
    if (plan) desk_.start(*plan, simulated ? app::LiveHand::Simulated : app::LiveHand::Mouse);
}

}  // namespace passung::window
