#pragma once

#include "study/run/person/performer.h"

namespace passung::run {

/// A person at a real device of the station, without a window: somebody asks and reads at a terminal.
class AtDevice final : public Performer {
public:
    AtDevice(plan::ParticipantKind kind, session::QuestionnaireSource* answers, session::InstructionReader* reader)
        : kind_(kind), answers_(answers), reader_(reader) {}

    plan::ParticipantKind kind() const override { return kind_; }
    session::QuestionnaireSource* answers() override { return answers_; }
    session::InstructionReader* reader() override { return reader_; }

private:
    plan::ParticipantKind kind_;
    session::QuestionnaireSource* answers_;
    session::InstructionReader* reader_;
};

}  // namespace passung::run
