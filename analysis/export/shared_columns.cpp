#include "analysis/export/shared_columns.h"

namespace passung::exporter {

using store::AttemptRow;

ColumnOf<AttemptRow> trialIndexColumn() { return {ofTrials("trial_index"), "integer", &AttemptRow::trial_index}; }

ColumnOf<AttemptRow> attemptNumberColumn() { return {ofTrials("attempt_no"), "integer", &AttemptRow::attempt_no}; }

ColumnOf<AttemptRow> conditionColumn() { return {ofTrials("condition"), "text", &AttemptRow::condition}; }

ColumnOf<AttemptRow> validColumn() { return {ofTrials("valid"), "0/1", &AttemptRow::valid, {"0", "1"}}; }

ColumnsOf<AttemptRow> attemptColumns() {
    ColumnsOf<AttemptRow> columns = participantSessionColumns<AttemptRow>();
    append(columns, {trialIndexColumn(), attemptNumberColumn()});
    return columns;
}

}  // namespace passung::exporter
