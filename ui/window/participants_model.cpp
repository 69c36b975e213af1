#include "ui/window/participants_model.h"

#include <QtCore/QCoreApplication>
#include <algorithm>
#include <filesystem>

#include "study/plan/language.h"
#include "study/run/files/protocol_files.h"
#include "study/store/schema/backup.h"
#include "ui/window/participants_words.h"
#include "ui/window/text.h"

namespace passung::window {

using plan::ParticipantKind;
using presenter::ParticipantEntry;
using presenter::Participants;
using presenter::PersonWhy;

namespace {

QString said(const char* text) { return QCoreApplication::translate("participants", text); }

/// "2026-11-22 05:44" of a time as it is stored.
QString minute(const std::string& utc) { return text(utc.substr(0, 16)).replace('T', ' '); }

ParticipantKind kindOf(bool pilot) { return pilot ? ParticipantKind::Pilot : ParticipantKind::Real; }

Result<Participants> readFrom(const std::string& protocol, const std::string& database) {
    const auto plan = run::readProtocol(protocol);
    if (!plan) return plan.errors();
    if (!std::filesystem::exists(database)) return presenter::noParticipants(*plan);
    const auto reader = store::StoreReader::open(database);
    if (!reader) return reader.errors();
    return presenter::readParticipants(*plan, *reader);
}

QVariantMap sessionMap(const presenter::SessionEntry& session) {
    const bool whole = session.state == presenter::SessionEnd::Complete;
    return {{"name", QString::number(session.ordinal)},
            {"date", minute(session.started_utc)},
            {"word", sessionWord(session.state)},
            {"tone", whole ? "good" : "wait"},
            {"trials", QStringLiteral("%1 / %2").arg(session.valid).arg(session.planned)}};
}

QVariantMap personMap(const Participants& participants, const ParticipantEntry& person) {
    QVariantList consent;
    for (const presenter::Decision decision : person.consent)
        consent.append(QVariantMap{{"sign", decisionSign(decision)},
                                   {"word", decisionWord(decision)},
                                   {"tone", decision == presenter::Decision::Yes          ? "good"
                                            : decision == presenter::Decision::NotAsked   ? "rest"
                                            : decision == presenter::Decision::OtherWords ? "wait"
                                                                                          : "bad"}});
    const bool takes_part = person.standing == presenter::Standing::TakesPart;
    QString place;
    if (person.place) {
        place = QString::number(person.place->slot + 1);
        if (participants.groups.size() > 1)
            place += QStringLiteral(" · ") + text(participants.groups[person.place->group]);
    }
    return {{"code", text(person.code)},
            {"kind", kindWord(person.kind)},
            {"standing", standingWord(person.standing)},
            {"takesPart", takes_part},
            {"excluded", person.standing == presenter::Standing::Excluded},
            {"reason", text(person.reason)},
            {"enrolled", minute(person.enrolled_utc)},
            {"place", place},
            {"complete", person.complete()},
            {"interrupted", person.interrupted()},
            {"of", participants.sessions},
            {"consent", consent}};
}

}  // namespace

ParticipantsModel::ParticipantsModel(Desk& desk, Studies& studies) : desk_(desk), studies_(studies) {
    connect(&studies_, &Studies::chosenChanged, this, [this] {
        participants_.reset();
        selected_.clear();
        told_.clear();
        dialog_.close();
        refresh();
    });
    connect(&desk_, &Desk::happened, this, [this] {
        if (sessionRuns() != ran_ && !sessionRuns()) refresh();
        if (sessionRuns() != ran_) emit changed();
        ran_ = sessionRuns();
    });
    refresh();
}

QString ParticipantsModel::database() const { return text(studies_.database()); }

const ParticipantEntry* ParticipantsModel::person_() const {
    return participants_ ? participants_->find(selected_) : nullptr;
}

std::string ParticipantsModel::by() const {
    const std::string name = experimenter_.trimmed().toStdString();
    return name.empty() ? "experimenter" : name;
}

void ParticipantsModel::refresh() {
    const presenter::StudyCard* card = studies_.card();
    if (card == nullptr || !card->sound) {
        participants_.reset();
        emit changed();
        return;
    }
    const int asked = ++asked_;
    worker_.run([protocol = card->path, database = studies_.database()] { return readFrom(protocol, database); },
                [this, asked](Result<Participants> participants) {
                    if (asked != asked_) return;
                    if (participants) {
                        participants_ = *std::move(participants);
                        if (person_() == nullptr) selected_.clear();
                    } else {
                        tell(participants.errors(), {});
                    }
                    emit changed();
                });
    emit changed();
}

void ParticipantsModel::tell(const Result<Done>& came, const QString& done) {
    failed_ = !came;
    told_ = came ? done : text(toString(came.errors().front()));
}

void ParticipantsModel::act(const Work& work, const QString& done) {
    const presenter::StudyCard* card = studies_.card();
    if (card == nullptr || sessionRuns()) return;
    presenter::ParticipantAccess access{.database = studies_.database(), .by = by(), .create = true};
    worker_.run(
        [work, access, protocol = card->path]() -> Result<Done> {
            const auto plan = run::readProtocol(protocol);
            if (!plan) return plan.errors();
            std::error_code problem;  // shows when the database is opened
            std::filesystem::create_directories(std::filesystem::path(access.database).parent_path(), problem);
            return presenter::withParticipants(
                access, [&](store::Store& store, store::ParticipantRecords& desk) -> Result<Done> {
                    if (const auto imported = store.importProtocol(*plan); !imported) return imported.errors();
                    return work(store, desk, *plan);
                });
        },
        [this, done](const Result<Done>& came) {
            tell(came, done);
            refresh();
        });
    emit changed();
}

QStringList ParticipantsModel::clauses() const {
    QStringList names;
    if (participants_)
        for (const auto& clause : participants_->clauses) names.append(text(clause.clause));
    return names;
}

QVariantList ParticipantsModel::people() const {
    QVariantList all;
    if (participants_)
        for (const ParticipantEntry& person : participants_->people) all.append(personMap(*participants_, person));
    return all;
}

QVariantMap ParticipantsModel::person() const {
    const ParticipantEntry* person = person_();
    if (person == nullptr) return {};
    QVariantMap map = personMap(*participants_, *person);
    QVariantList sessions;
    for (const auto& session : person->sessions) sessions.append(sessionMap(session));
    map["sessions"] = sessions;
    map["whyNotStart"] = whyNot(presenter::whyNotStart(*participants_, *person, sessionRuns()));
    map["whyNotResume"] = whyNot(presenter::whyNotResume(*participants_, *person, sessionRuns()));
    const presenter::SessionEntry* broken = person->resumable();
    map["canResume"] = broken != nullptr;
    map["cutOff"] = broken ? cutOffLine(person->code, minute(broken->started_utc), *broken) : QString();
    return map;
}

void ParticipantsModel::select(const QString& code) {
    if (code == selected()) return;
    selected_ = code.toStdString();
    dialog_.close();
    emit changed();
}

QVariantList ParticipantsModel::places() const {
    QVariantList all;
    if (!participants_) return all;
    for (const auto& place : participants_->places)
        all.append(QVariantMap{
            {"name", QString::number(place.at.slot + 1)},
            {"group", participants_->groups.size() > 1 ? text(participants_->groups[place.at.group]) : QString()},
            {"owner", text(place.owner)},
            {"done", place.done}});
    return all;
}

QStringList ParticipantsModel::balance() const {
    return participants_ ? balanceLines(participants_->balance) : QStringList();
}

QString ParticipantsModel::proposedCode(bool pilot) const {
    return participants_ ? text(presenter::proposedCode(*participants_, kindOf(pilot))) : QString();
}

QString ParticipantsModel::whyNotEnrol(const QString& code, bool pilot) const {
    if (!participants_) return {};
    if (sessionRuns()) return whyNot(PersonWhy::SessionRuns);
    return whyNot(presenter::whyNotEnrol(*participants_, code.toStdString(), kindOf(pilot)), kindOf(pilot));
}

void ParticipantsModel::enrol(const QString& code, bool pilot) {
    if (!whyNotEnrol(code, pilot).isEmpty()) return;
    selected_ = code.toStdString();
    act(
        [code = selected_, kind = kindOf(pilot)](store::Store& store, store::ParticipantRecords& desk,
                                                 const plan::StudyPlan&) -> Result<Done> {
            const auto enrolled = presenter::enrolAt(store, desk, kind, code);
            if (!enrolled) return enrolled.errors();
            return Done{};
        },
        said(QT_TRANSLATE_NOOP("participants", "%1 is enrolled.")).arg(code));
}

bool ParticipantsModel::start(bool resume, const QString& language) {
    const ParticipantEntry* person = person_();
    if (person == nullptr || studies_.card() == nullptr) return false;
    const PersonWhy why = resume ? presenter::whyNotResume(*participants_, *person, sessionRuns())
                                 : presenter::whyNotStart(*participants_, *person, sessionRuns());
    if (why != PersonWhy::Possible) return false;
    const auto plan = run::readProtocol(studies_.card()->path);
    if (!plan) {
        tell(plan.errors(), {});
        emit changed();
        return false;
    }
    window::LiveOptions options;
    options.database = studies_.database();
    options.participant = person->code;
    options.kind = person->kind;
    if (resume) options.resume = person->resumable()->id;
    const auto languages = plan::languagesOf(*plan);
    const bool spoken = std::find(languages.begin(), languages.end(), language.toStdString()) != languages.end();
    options.language = spoken ? language.toStdString() : languages.front();
    options.experimenter = by();
    options.waits = true;
    emit began(text(studies_.card()->path), selected());
    desk_.start(*plan, std::move(options));
    return true;
}

void ParticipantsModel::decide(int clause, const QString& decision) {
    const ParticipantEntry* person = person_();
    if (person == nullptr || clause < 0 || clause >= static_cast<int>(participants_->clauses.size())) return;
    const auto& asked = participants_->clauses[static_cast<std::size_t>(clause)];
    const auto answer = decision == "yes"  ? store::Consent::Yes
                        : decision == "no" ? store::Consent::No
                                           : store::Consent::Withdrawn;
    act(
        [code = person->code, name = asked.clause, language = asked.texts.front().first, answer](
            store::Store&, store::ParticipantRecords& desk, const plan::StudyPlan&) -> Result<Done> {
            const auto decided = desk.decide(code, {name}, language, answer);
            if (!decided) return decided.errors();
            return Done{};
        },
        said(QT_TRANSLATE_NOOP("participants", "%1: the decision on “%2” is stored."))
            .arg(selected(), text(asked.clause)));
}

QString ParticipantsModel::whyNotReadmit(const QString& reason) const {
    const ParticipantEntry* person = person_();
    if (person == nullptr) return {};
    return whyNot(presenter::whyNotReadmit(*person, reason.trimmed().toStdString(), sessionRuns()));
}

void ParticipantsModel::readmit(const QString& reason) {
    if (person_() == nullptr || !whyNotReadmit(reason).isEmpty()) return;
    act(
        [code = selected_, why = reason.trimmed().toStdString()](store::Store&, store::ParticipantRecords& desk,
                                                                 const plan::StudyPlan&) -> Result<Done> {
            const auto placed = desk.readmit(code, why);
            if (!placed) return placed.errors();
            return Done{};
        },
        said(QT_TRANSLATE_NOOP("participants", "%1 takes part again.")).arg(selected()));
}

QVariantMap ParticipantsModel::leaving() const {
    using Step = presenter::LeavingDialog::Step;
    const bool confirms = dialog_.step() == Step::Confirm;
    std::error_code none;
    return {{"open", dialog_.step() != Step::Closed},
            {"confirms", confirms},
            {"code", text(dialog_.code())},
            {"hasBackup", confirms && std::filesystem::exists(store::backupPath(studies_.database()), none)},
            {"erases", confirms && dialog_.leaving().scope == presenter::Scope::Erase},
            {"lines", confirms ? leavingLines(dialog_.leaving()) : QStringList()}};
}

void ParticipantsModel::openLeaving() {
    if (person_() == nullptr) return;
    dialog_.open(*person_());
    emit changed();
}

void ParticipantsModel::closeLeaving() {
    dialog_.close();
    emit changed();
}

QString ParticipantsModel::whyNotChoose(int scope, const QString& reason) const {
    return whyNot(
        dialog_.whyNotChoose(static_cast<presenter::Scope>(scope), reason.trimmed().toStdString(), sessionRuns()));
}

void ParticipantsModel::chooseLeaving(int scope, const QString& reason) {
    if (!whyNotChoose(scope, reason).isEmpty()) return;
    dialog_.choose(static_cast<presenter::Scope>(scope), reason.trimmed().toStdString());
    emit changed();
}

void ParticipantsModel::backLeaving() {
    dialog_.back();
    emit changed();
}

QString ParticipantsModel::whyNotConfirm(const QString& typed) const {
    return whyNot(dialog_.whyNotConfirm(typed.trimmed().toStdString(), sessionRuns()));
}

void ParticipantsModel::confirmLeaving(const QString& typed, bool backupToo) {
    const auto leaving = dialog_.confirm(typed.trimmed().toStdString(), sessionRuns(), backupToo);
    if (!leaving) return;
    const presenter::ParticipantAccess access{.database = studies_.database(), .by = by()};
    worker_.run(
        [access, what = *leaving] { return presenter::leave(access, what); },
        [this, what = *leaving](const Result<presenter::Left>& left) {
            tell(left ? Result<Done>(Done{}) : Result<Done>(left.errors()),
                 said(QT_TRANSLATE_NOOP("participants", "%1 has left the study.")).arg(text(what.code)));
            if (left && left->backup)
                told_ += " " + said(QT_TRANSLATE_NOOP("participants", "They were erased from the backup too."));
            if (left && !left->backup_problem.empty())
                told_ += " " + said(QT_TRANSLATE_NOOP("participants", "They could not be erased from the backup: %1"))
                                   .arg(text(left->backup_problem));
            if (left && !left->copies.empty()) {
                QStringList copies;
                for (const auto& copy : left->copies) copies.append(text(copy));
                told_ +=
                    " " + said(QT_TRANSLATE_NOOP("participants", "Delete these copies too: %1")).arg(copies.join(", "));
            }
            refresh();
        });
    emit changed();
}

void ParticipantsModel::retranslate() {
    told_.clear();  // said in the language before
    emit changed();
}

}  // namespace passung::window
