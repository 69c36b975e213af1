#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/store/read/store_reader.h"

namespace passung::exporter {

/// A factor as a column of the exports: factors of one name in several protocols share it.
struct FactorColumn {
    std::string factor;
    std::string column;  // the factor's name, with "factor_" before it where that is another column's name
    std::string kind;
    std::string unit;
    std::vector<std::string> levels;
};

/// Whom and what the protocols' rules on recorded values leave out, and why.
struct LeftOut {
    std::map<std::int64_t, std::string> attempts;                             // by attempt_id
    std::map<std::pair<std::string, std::string>, std::string> participants;  // by protocol, participant
};

/// Everything of a database that the tables are made of, samples apart.
struct StudyData {
    std::vector<store::ProtocolRow> protocols;
    std::vector<FactorColumn> factors;
    std::vector<store::ConditionRow> conditions;
    std::vector<store::PlannedCellRow> planned;
    std::vector<store::AnalysisRow> analyses;
    std::vector<store::DataRuleRow> data_rules;
    LeftOut left_out;                         // by these rules
    std::vector<store::MeasureRow> measures;  // those that a protocol names
    std::vector<store::MeasureRow> counters;  // likewise, of ticks: how the loop did
    std::vector<store::ParticipantRow> participants;
    std::vector<store::SessionRow> sessions;
    std::vector<store::AttemptRow> attempts;
    std::vector<store::NoteRow> notes;
    std::vector<store::DetectionRow> detections;  // of the attempts, in their order
    std::vector<store::StaircaseTrackRow> staircase_tracks;
    std::vector<store::StaircaseStepRow> staircase_steps;
    std::vector<store::QuestionnaireRunRow> questionnaires;
    std::vector<store::QuestionnaireRow> definitions;
    std::vector<store::NamedFileRow> files;
    std::vector<store::AccuracyRow> accuracy;  // of protocols with contact.accuracy = "auto"
    std::vector<store::DamageRow> damages;     // for which rows are missing
    std::vector<store::Extra> extras;          // that some attempt's ticks have beside
};

Result<StudyData> readStudy(const store::StoreReader& reader);

/// The label of `factor`, NA where the condition does not have it.
std::string levelOf(const store::Levels& levels, const std::string& factor);

/// Group of the between-subjects factors that the participant has; "all" in studies without any, NA of
/// whoever gave their place back.
std::string groupOf(const StudyData& study, const std::string& participant);

/// Row of the counterbalancing that the participant has; NA if none.
std::string sequenceOf(const StudyData& study, const std::string& participant);

/// Does the attempt count in means, if its session does? By AttemptRow::counts() and the protocols' rules.
bool countsInMeans(const StudyData& study, const store::AttemptRow& attempt);

/// Of each participant and protocol the sessions that means are taken over: the complete ones, else the latest; none
/// of whoever is excluded or left out by a rule.
std::set<std::string> countedSessions(const StudyData& study);

}  // namespace passung::exporter
