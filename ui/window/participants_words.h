#pragma once

#include <QtCore/QString>

#include "ui/presenter/leaving.h"
#include "ui/presenter/participants.h"

namespace passung::window {

// What a participants means, in the language of the windows.

QString kindWord(plan::ParticipantKind kind);
QString standingWord(presenter::Standing standing);
QString decisionWord(presenter::Decision decision);
/// A sign that tells decisions apart without colour.
QString decisionSign(presenter::Decision decision);
QString sessionWord(presenter::SessionEnd state);
/// How far a session came that ended before its time; `began`: when it did, in words.
QString cutOffLine(const std::string& code, const QString& began, const presenter::SessionEntry& session);
QString whyNot(presenter::PersonWhy why);
QString whyNot(presenter::CodeWhy why, plan::ParticipantKind kind);
/// What a participant's leaving does, a sentence each.
QStringList leavingLines(const presenter::Leaving& leaving);
/// How even the orders are, a line for everything that takes turns.
QStringList balanceLines(const presenter::DesignBalance& balance);

}  // namespace passung::window
