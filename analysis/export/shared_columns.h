#pragma once

#include <string>
#include <utility>

#include "analysis/export/columns.h"
#include "analysis/export/study_data.h"
#include "study/plan/participant.h"

namespace passung::exporter {

// Columns that several tables have, of any row with the members that are named here.

inline const store::ViewColumn& ofTrials(std::string_view name) {
    return store::viewColumn(store::StudyView::Trials, name);
}

/// participant_id, kind.
template <class Row>
ColumnsOf<Row> participantColumns() {
    return {{ofTrials("participant_id"), "text", &Row::participant_id},
            {ofTrials("kind"), "text", &Row::kind, plan::participantKindNames()}};
}

/// session.
template <class Row>
ColumnOf<Row> sessionColumn(std::int64_t Row::*ordinal = &Row::session_ordinal) {
    return {ofTrials("session"), "integer", ordinal};
}

/// participant_id, kind, session.
template <class Row>
ColumnsOf<Row> participantSessionColumns() {
    ColumnsOf<Row> columns = participantColumns<Row>();
    columns.push_back(sessionColumn<Row>());
    return columns;
}

/// participant_id, kind, group.
template <class Row>
ColumnsOf<Row> whoColumns() {
    ColumnsOf<Row> columns = participantColumns<Row>();
    append(columns, {{ofTrials("group"), "text", &Row::group}});
    return columns;
}

/// order_sequence, by sequenceOf(). Refers to `study`.
template <class Row>
ColumnOf<Row> sequenceColumn(const StudyData& study) {
    return {ofTrials("order_sequence"), "integer",
            [&study](const Row& row) { return sequenceOf(study, row.participant_id); }};
}

template <class Row>
ColumnOf<Row> blockIndexColumn() {
    return {ofTrials("block_index"), "integer", &Row::block_index};
}

template <class Row>
ColumnOf<Row> blockColumn() {
    return {ofTrials("block"), "text", &Row::block};
}

/// A column for each factor of the study, by the levels of the row's condition.
template <class Row, class GetLevels>
void appendFactors(ColumnsOf<Row>& columns, const StudyData& study, GetLevels levels) {
    for (const FactorColumn& factor : study.factors)
        columns.push_back(
            {factor.column,
             "Factor " + factor.factor + " (" + factor.kind + ")",
             "text",
             [levels, name = factor.factor](const Row& row) { return levelOf(std::invoke(levels, row), name); },
             {.unit = factor.unit, .levels = factor.levels}});
}

/// protocol_sha256; `where`: what the label says of the text's place.
template <class Row>
ColumnOf<Row> protocolColumn(const std::string& where = "") {
    const store::ViewColumn& column = ofTrials("protocol_sha256");
    return {column.name, column.label + where, "text", &Row::protocol_sha256};
}

inline constexpr const char* kInFolder = ", see protocol/";

// Columns of an attempt.
ColumnOf<store::AttemptRow> trialIndexColumn();
ColumnOf<store::AttemptRow> attemptNumberColumn();
ColumnOf<store::AttemptRow> conditionColumn();
ColumnOf<store::AttemptRow> validColumn();

/// participant_id, kind, session, trial_index, attempt_no.
ColumnsOf<store::AttemptRow> attemptColumns();

/// The attempt that a row is about.
template <class Row>
const store::AttemptRow& attemptOf(const Row& row) {
    return *row.attempt;
}

/// A long table of the rows that `rows_of` makes of each attempt: it calls its second argument with them.
/// @pre the study, and what the columns refer to, outlive the table
template <class Row, class RowsOf>
Table makeAttemptTable(const StudyData& study, std::string file, std::string about, ColumnsOf<Row> columns,
                       RowsOf rows_of) {
    return makeLongTable<Row>(std::move(file), std::move(about), std::move(columns),
                              [&study, rows_of = std::move(rows_of)](const auto& take) {
                                  for (const store::AttemptRow& attempt : study.attempts) rows_of(attempt, take);
                                  return Done{};
                              });
}

}  // namespace passung::exporter
