#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace passung::store {

/// A column that a view of the database has, and a table of an export where there is the same one: its meaning and its
/// SQL are said here alone.
struct ViewColumn {
    std::string name;
    std::string sql;  // of a row of the view's `from`, by the names of tables there
    std::string label;
    std::string unit = {};     // empty: none
    std::string formula = {};  // empty: as recorded
    int formula_version = 1;
    bool typed = false;        // texts that somebody typed: they may name a person
    std::string in_view = {};  // SQL in the view itself, which knows the protocols' [[exclude]]; empty: the same
};

enum class StudyView { Trials, Cells, Scores, Events, Thresholds };
inline constexpr std::array kStudyViews{StudyView::Trials, StudyView::Cells, StudyView::Scores, StudyView::Events,
                                        StudyView::Thresholds};

/// What a view is of all studies. Those of factors and measures stand before the columns of these names, if any.
struct ViewText {
    std::string name;  // "v_trials"
    std::vector<ViewColumn> columns;
    std::string factors_before, measures_before;
    std::string with;  // before SELECT
    std::string from;  // after the columns
};
const ViewText& textOf(StudyView view);

/// The column of this name. @pre the view has it
const ViewColumn& viewColumn(StudyView view, std::string_view name);

/// SQL of an `event e` of a `segment g`: its UTC by the session's epoch. Only virtual time and older
/// programs stored none.
inline constexpr const char* kEventUtc =
    "coalesce(e.t_utc, strftime('%Y-%m-%dT%H:%M:%fZ', g.utc_zero, printf('+%.9f seconds', e.t_ns * 1e-9)))";

/// SQL that tells of a row of `session s` with its `participant pa` whether means are taken over it: of each
/// participant and protocol the complete sessions, else the latest; none of whoever is excluded.
const std::string& countedSession();

}  // namespace passung::store
