#include "ui/window/participants_words.h"

#include <QtCore/QCoreApplication>
#include <QtCore/QStringList>

namespace passung::window {

using plan::ParticipantKind;
using presenter::CodeWhy;
using presenter::Decision;
using presenter::PersonWhy;
using presenter::Scope;
using presenter::SessionEnd;
using presenter::Standing;

namespace {

QString said(const char* text) { return QCoreApplication::translate("participants", text); }

QString range(const design::CountRange& range) { return QString::fromStdString(design::rangeText(range)); }

QString factorName(const design::FactorBalance& of, const std::vector<std::string>& factors) {
    const QString factor = of.balancing.factor ? QString::fromStdString(factors[*of.balancing.factor]) : QString();
    switch (of.balancing.what) {
        case design::CounterbalancingFactor::What::Conditions:
            return factor.isEmpty() ? said(QT_TRANSLATE_NOOP("participants", "Conditions"))
                                    : said(QT_TRANSLATE_NOOP("participants", "Conditions within %1")).arg(factor);
        case design::CounterbalancingFactor::What::Levels:
            return said(QT_TRANSLATE_NOOP("participants", "Levels of %1")).arg(factor);
        case design::CounterbalancingFactor::What::Assignment:
            break;
    }
    return said(QT_TRANSLATE_NOOP("participants", "Assignment of %1")).arg(factor);
}

QString balanceLine(const design::FactorBalance& of, const std::vector<std::string>& factors) {
    const bool assigned = of.balancing.what == design::CounterbalancingFactor::What::Assignment;
    const QString name = factorName(of, factors);
    const QString counts =
        assigned
            ? said(QT_TRANSLATE_NOOP("participants", "%1 (%2 rows): each pair %3 times"))
                  .arg(name)
                  .arg(of.rows)
                  .arg(range(of.counts.positions))
            : said(QT_TRANSLATE_NOOP("participants", "%1 (%2 rows): each position %3 times, each neighbour %4 times"))
                  .arg(name)
                  .arg(of.rows)
                  .arg(range(of.counts.positions), range(of.counts.neighbours));
    return counts + QStringLiteral(" – ") +
           (of.even ? said(QT_TRANSLATE_NOOP("participants", "balanced"))
                    : said(QT_TRANSLATE_NOOP("participants", "not balanced yet")));
}

}  // namespace

QString kindWord(ParticipantKind kind) {
    switch (kind) {
        case ParticipantKind::Real:
            return said(QT_TRANSLATE_NOOP("participants", "person"));
        case ParticipantKind::Pilot:
            return said(QT_TRANSLATE_NOOP("participants", "pilot"));
        case ParticipantKind::Simulated:
            break;
    }
    return said(QT_TRANSLATE_NOOP("participants", "simulated"));
}

QString standingWord(Standing standing) {
    switch (standing) {
        case Standing::TakesPart:
            return said(QT_TRANSLATE_NOOP("participants", "takes part"));
        case Standing::Withdrawn:
            return said(QT_TRANSLATE_NOOP("participants", "withdrawn"));
        case Standing::WithdrawnWithData:
            return said(QT_TRANSLATE_NOOP("participants", "withdrawn with data"));
        case Standing::Excluded:
            break;
    }
    return said(QT_TRANSLATE_NOOP("participants", "excluded"));
}

QString decisionWord(Decision decision) {
    switch (decision) {
        case Decision::NotAsked:
            return said(QT_TRANSLATE_NOOP("participants", "not asked yet"));
        case Decision::OtherWords:
            return said(QT_TRANSLATE_NOOP("participants", "decided on an earlier text"));
        case Decision::Yes:
            return said(QT_TRANSLATE_NOOP("participants", "agreed"));
        case Decision::No:
            return said(QT_TRANSLATE_NOOP("participants", "declined"));
        case Decision::Withdrawn:
            break;
    }
    return said(QT_TRANSLATE_NOOP("participants", "withdrawn"));
}

QString decisionSign(Decision decision) {
    switch (decision) {
        case Decision::NotAsked:
            return QStringLiteral("·");
        case Decision::OtherWords:
            return QStringLiteral("?");
        case Decision::Yes:
            return QStringLiteral("✓");
        case Decision::No:
        case Decision::Withdrawn:
            break;
    }
    return QStringLiteral("✕");
}

QString sessionWord(SessionEnd state) {
    switch (state) {
        case SessionEnd::Open:
            return said(QT_TRANSLATE_NOOP("participants", "open"));
        case SessionEnd::Complete:
            return said(QT_TRANSLATE_NOOP("participants", "complete"));
        case SessionEnd::Aborted:
            return said(QT_TRANSLATE_NOOP("participants", "interrupted"));
        case SessionEnd::Crashed:
            break;
    }
    return said(QT_TRANSLATE_NOOP("participants", "interrupted by a crash"));
}

QString cutOffLine(const std::string& code, const QString& began, const presenter::SessionEntry& session) {
    const QString who = QString::fromStdString(code);
    if (session.in_form)
        return said(QT_TRANSLATE_NOOP("participants",
                                      "%1's session of %2 was cut off in a questionnaire, after %3 of %4 trials."))
            .arg(who, began)
            .arg(session.valid)
            .arg(session.planned);
    if (session.valid >= session.planned)
        return said(QT_TRANSLATE_NOOP("participants", "%1's session of %2 was cut off after its trials."))
            .arg(who, began);
    return said(QT_TRANSLATE_NOOP("participants", "%1's session of %2 was cut off in trial %3 of %4."))
        .arg(who, began)
        .arg(session.valid + 1)
        .arg(session.planned);
}

QString whyNot(PersonWhy why) {
    switch (why) {
        case PersonWhy::Possible:
            return {};
        case PersonWhy::SessionRuns:
            return said(QT_TRANSLATE_NOOP("participants", "A session is running."));
        case PersonWhy::TakesNoPart:
            return said(QT_TRANSLATE_NOOP("participants", "They take part no more."));
        case PersonWhy::Simulated:
            return said(QT_TRANSLATE_NOOP("participants", "Simulated participants are run from the command line."));
        case PersonWhy::AllDone:
            return said(QT_TRANSLATE_NOOP("participants", "All their sessions are complete."));
        case PersonWhy::NothingInterrupted:
            return said(QT_TRANSLATE_NOOP("participants", "No session was interrupted."));
        case PersonWhy::NotOut:
            return said(QT_TRANSLATE_NOOP("participants", "They take part."));
        case PersonWhy::OwnWish:
            return said(QT_TRANSLATE_NOOP("participants", "They withdrew; only they could take that back."));
        case PersonWhy::OutAlready:
            return said(QT_TRANSLATE_NOOP("participants", "They are out of the study already."));
        case PersonWhy::NeedsReason:
            return said(QT_TRANSLATE_NOOP("participants", "Give a reason."));
        case PersonWhy::CueWithoutOutput:
            return said(QT_TRANSLATE_NOOP("participants",
                                          "The study has a cue that nothing here can give to a person; only simulated "
                                          "participants can take part."));
        case PersonWhy::NeedsCode:
            break;
    }
    return said(QT_TRANSLATE_NOOP("participants", "Type the code to confirm."));
}

QString whyNot(CodeWhy why, ParticipantKind kind) {
    switch (why) {
        case CodeWhy::Possible:
            return {};
        case CodeWhy::NotACode:
            return said(QT_TRANSLATE_NOOP(
                "participants",
                "A code begins with a capital letter and ends with a digit; capitals, digits, - and _ between."));
        case CodeWhy::WrongLetter:
            return kind == ParticipantKind::Pilot
                       ? said(QT_TRANSLATE_NOOP("participants", "Codes of pilots begin with T."))
                       : said(QT_TRANSLATE_NOOP("participants", "Codes of persons begin with P."));
        case CodeWhy::Taken:
            return said(QT_TRANSLATE_NOOP("participants", "This code is enrolled already."));
        case CodeWhy::MayBeErased:
            break;
    }
    return said(QT_TRANSLATE_NOOP("participants", "Somebody who was erased may have had this code."));
}

QStringList leavingLines(const presenter::Leaving& leaving) {
    const QString stock = said(QT_TRANSLATE_NOOP("participants", "%1 sessions, %2 attempts, %3 questionnaires"))
                              .arg(leaving.sessions)
                              .arg(leaving.attempts)
                              .arg(leaving.forms);
    QStringList lines;
    switch (leaving.scope) {
        case Scope::Stop:
            lines << said(QT_TRANSLATE_NOOP("participants", "Takes part no more; consent ends."))
                  << said(QT_TRANSLATE_NOOP("participants", "Nothing is deleted: %1 stay and count in the analysis."))
                         .arg(stock);
            break;
        case Scope::Exclude:
        case Scope::Dismiss:
            lines
                << (leaving.scope == Scope::Exclude
                        ? said(QT_TRANSLATE_NOOP("participants",
                                                 "Takes part no more; consent ends. Cannot be taken back."))
                        : said(QT_TRANSLATE_NOOP("participants", "Takes part no more. Can be taken back.")))
                << said(QT_TRANSLATE_NOOP("participants", "Nothing is deleted: %1 stay and count nowhere.")).arg(stock);
            break;
        case Scope::Erase:
            lines << said(QT_TRANSLATE_NOOP("participants",
                                            "Deleted for good: %1, every recorded tick, every consent and "
                                            "note of %2."))
                         .arg(stock, QString::fromStdString(leaving.code))
                  << said(QT_TRANSLATE_NOOP("participants", "The audit keeps that somebody was erased, not who."))
                  << said(QT_TRANSLATE_NOOP("participants", "Exports, and copies elsewhere, are yours to delete."));
            break;
    }
    if (leaving.frees_place)
        lines << said(QT_TRANSLATE_NOOP("participants", "Their slot is free for the next participant."));
    return lines;
}

QStringList balanceLines(const presenter::DesignBalance& balance) {
    QStringList lines;
    for (const auto& group : balance.groups) {
        if (group.participants == 0) continue;
        if (balance.groups.size() > 1)
            lines << said(QT_TRANSLATE_NOOP("participants", "Group %1, participants: %2"))
                         .arg(QString::fromStdString(group.group))
                         .arg(group.participants);
        for (const auto& balancing : group.balancings) lines << balanceLine(balancing, balance.factors);
    }
    if (balance.even_number > 1)
        lines << said(QT_TRANSLATE_NOOP("participants", "Even with multiples of %1 participants; %2 are planned."))
                     .arg(balance.even_number)
                     .arg(balance.planned);
    return lines;
}

}  // namespace passung::window
