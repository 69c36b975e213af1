#include "ui/window/studies.h"

#include <cmath>

#include "study/run/files/known_names.h"
#include "study/run/files/protocol_files.h"
#include "ui/presenter/participant_access.h"
#include "ui/window/registry_words.h"
#include "ui/window/text.h"

namespace passung::window {

namespace {

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
            {"forPeople", card.for_people},
            {"problems", problems},
            {"warnings", warnings},
            {"factors", factors},
            {"questionnaires", questionnaires},
            {"conditions", static_cast<int>(card.conditions)},
            {"trials", static_cast<int>(card.trials)},
            {"sessions", card.sessions},
            {"minutes", static_cast<int>(std::ceil(card.minutes))},
            {"participants", card.participants},
            {"device", deviceWord(card.device)}};
}

}  // namespace

Studies::Studies(Desk& desk, const std::string& folder, std::string tryouts)
    : desk_(desk), folder_(folder), tryouts_(std::move(tryouts)) {
    reload();
}

void Studies::reload() {
    cards_.clear();
    for (const std::string& file : presenter::studyFilesBelow(folder_))
        cards_.push_back(presenter::cardOf(file, run::readProtocol(file), run::knownDevices()));
    if (chosen_ >= static_cast<int>(cards_.size())) chosen_ = 0;
    emit changed();
    emit chosenChanged();
}

void Studies::choose(int card) {
    if (card == chosen_ || card < 0 || card >= static_cast<int>(cards_.size())) return;
    chosen_ = card;
    emit chosenChanged();
}

bool Studies::chooseFile(const QString& path) {
    for (std::size_t i = 0; i < cards_.size(); ++i) {
        if (text(cards_[i].path) != path) continue;
        choose(static_cast<int>(i));
        return true;
    }
    return false;
}

const presenter::StudyCard* Studies::card() const {
    return cards_.empty() ? nullptr : &cards_[static_cast<std::size_t>(chosen_)];
}

std::string Studies::database() const {
    return card() ? presenter::studyDatabase(tryouts_, card()->name) : std::string();
}
std::string Studies::tryOuts() const { return card() ? tryouts_ + "/" + card()->name + ".db" : std::string(); }

QVariantList Studies::cards() const {
    QVariantList all;
    for (const auto& card : cards_) all.append(cardMap(card));
    return all;
}

void Studies::tryOut(int card, bool simulated, const QString& language) {
    const auto& path = cards_.at(static_cast<std::size_t>(card)).path;
    const auto plan = run::readProtocol(path);
    if (plan)
        desk_.tryOut(*plan, simulated ? window::LiveHand::Simulated : window::LiveHand::Mouse, language.toStdString());
}

}  // namespace passung::window
