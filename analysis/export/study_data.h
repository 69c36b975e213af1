#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/store/store_reader.h"

namespace passung::exporter {

/// A factor as a column of the exports: factors of one name in several protocols share it.
struct FactorColumn {
    std::string factor;
    std::string column;  // the factor's name, with "factor_" before it where that is another column's name
    std::string kind;
    std::string unit;
    std::vector<std::string> levels;
};

/// Everything of a database that the tables are made of, samples apart.
struct StudyData {
    std::vector<store::ProtocolRow> protocols;
    std::vector<FactorColumn> factors;
    std::vector<store::ConditionRow> conditions;
    std::vector<store::MeasureRow> measures;  // those that a protocol names
    std::vector<store::ParticipantRow> participants;
    std::vector<store::SessionRow> sessions;
    std::vector<store::AttemptRow> attempts;
    std::vector<store::EventRow> events;
    std::vector<store::NoteRow> notes;
    std::vector<store::DetectionRow> detections;  // of the attempts, in their order
    std::vector<store::StaircaseTrackRow> staircase_tracks;
    std::vector<store::StaircaseStepRow> staircase_steps;
    std::vector<store::QuestionnaireRunRow> questionnaires;
    std::vector<store::AccuracyRow> accuracy;  // of protocols with contact.accuracy = "auto"
};

Result<StudyData> readStudy(const store::StoreReader& reader);

/// The label of `factor`, NA where the condition does not have it.
std::string levelOf(const store::Levels& levels, const std::string& factor);

/// Of each participant and protocol the sessions that means are taken over: the complete ones, else the latest; none
/// of whoever is excluded.
std::set<std::string> countedSessions(const StudyData& study);

/// Attempts that count in means (AttemptRow::counts()) of the counted session, of one participant under one protocol
/// and condition.
struct Cell {
    std::string participant_id;
    std::string kind;
    std::string group;
    std::string protocol_sha256;
    const store::ConditionRow* condition = nullptr;
    std::vector<const store::AttemptRow*> attempts;
};

/// A cell for each condition of the protocol that a participant had at least one attempt in, empty ones too, but none
/// for catch trials and those of staircases, nor for conditions of other groups or assignments than the participant's;
/// by participant, then protocol, then condition as the protocol lists them. Refers to `study`.
std::vector<Cell> cellsOf(const StudyData& study);

/// The values of `measure` of those attempts for which it is defined.
std::vector<double> valuesOf(const std::vector<const store::AttemptRow*>& attempts, const std::string& measure);

/// NaN for no values.
double meanOf(const std::vector<double>& values);
double medianOf(std::vector<double> values);

}  // namespace passung::exporter
