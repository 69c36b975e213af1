#include "analysis/export/shared_columns.h"

namespace passung::exporter {

using store::AttemptRow;

ColumnOf<AttemptRow> trialIndexColumn() {
    return {"trial_index", "Number of the trial in the session, from 0", "integer", &AttemptRow::trial_index};
}

ColumnOf<AttemptRow> attemptNumberColumn() {
    return {"attempt_no", "Number of the attempt at this trial, from 1", "integer", &AttemptRow::attempt_no};
}

ColumnOf<AttemptRow> conditionColumn() {
    return {"condition", "Name of the condition: its levels joined by /", "text", &AttemptRow::condition};
}

ColumnOf<AttemptRow> validColumn() {
    return {"valid", "1 if the attempt may be analysed", "0/1", &AttemptRow::valid, {.levels = {"0", "1"}}};
}

ColumnsOf<AttemptRow> attemptColumns() {
    ColumnsOf<AttemptRow> columns = participantSessionColumns<AttemptRow>();
    append(columns, {trialIndexColumn(), attemptNumberColumn()});
    return columns;
}

}  // namespace passung::exporter
