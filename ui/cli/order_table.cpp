#include "ui/cli/order_table.h"

#include "analysis/export/table.h"

namespace passung::cli {

std::string orderCsv(const plan::StudyPlan& plan, const std::vector<session::PlannedSession>& sessions) {
    exporter::Table table;
    const auto add = [&](const std::string& name) { table.columns.push_back({name, "", "", "", "", 1, {}}); };
    for (const char* name : {"participant_id", "group", "session", "block_index", "block", "phase", "trial_index",
                             "trial_in_block", "repetition", "condition"})
        add(name);
    for (const plan::Factor& factor : plan.factors) add(factor.name);
    const auto groups = plan::groupNames(plan);
    const auto number = [](auto value) { return exporter::cell(static_cast<std::int64_t>(value)); };
    for (const session::PlannedSession& planned : sessions)
        for (const design::PlannedTrial& trial : planned.trials) {
            const plan::Condition& condition = plan.conditions[trial.condition];
            std::vector<std::string> row = {planned.participant,
                                            groups[planned.place.group],
                                            number(planned.session),
                                            number(trial.block_index),
                                            trial.block,
                                            trial.phase,
                                            number(trial.trial_index),
                                            number(trial.trial_in_block),
                                            number(trial.repetition),
                                            condition.name};
            for (std::size_t f = 0; f < plan.factors.size(); ++f)
                row.push_back(plan.factors[f].levels[condition.levels[f]].label);
            table.rows.push_back(std::move(row));
        }
    return exporter::toCsv(table);
}

}  // namespace passung::cli
