#include "study/store/schema/study_views.h"

#include <algorithm>
#include <set>
#include <vector>

#include "core/base/digest.h"
#include "study/store/schema/view_columns.h"

namespace passung::store {
namespace {

std::string quotedName(const std::string& name) {
    std::string text = "\"";
    for (const char c : name) text += c == '"' ? "\"\"" : std::string(1, c);
    return text + '"';
}

std::string quotedText(const std::string& value) {
    std::string text = "'";
    for (const char c : value) text += c == '\'' ? "''" : std::string(1, c);
    return text + '\'';
}

/// Factors by name, in the order of the protocols' first one that has them; of equal names the first kind and unit.
struct StudyFactor {
    std::string name, kind, unit;
};

std::vector<StudyFactor> readFactors(const Database& database) {
    std::vector<StudyFactor> factors;
    Statement rows = database.prepare(
        "SELECT f.factor, f.kind, coalesce(f.unit, '') FROM factor f JOIN protocol_version p USING(protocol_sha256) "
        "ORDER BY p.name, p.version, p.protocol_sha256, f.position");
    while (rows.step()) {
        const StudyFactor factor{rows.text(0), rows.text(1), rows.text(2)};
        if (std::none_of(factors.begin(), factors.end(), [&](const StudyFactor& f) { return f.name == factor.name; }))
            factors.push_back(factor);
    }
    return factors;
}

constexpr const char* kMeasures =
    "FROM measure WHERE measure IN(SELECT measure FROM protocol_measure) AND measure NOT GLOB '*_ticks'";

std::vector<std::string> readMeasures(const Database& database) {
    std::vector<std::string> measures;
    Statement rows = database.prepare(std::string("SELECT measure ") + kMeasures + " ORDER BY position, measure");
    while (rows.step()) measures.push_back(rows.text(0));
    return measures;
}

/// The study's own part of the views.
struct StudyColumns {
    std::vector<StudyFactor> factors;
    std::vector<std::string> measures;
    bool staircases = false;
};

std::string factorSql(const StudyFactor& factor) {
    std::string key;  // of a path of JSON
    for (const char c : factor.name) key += c == '"' ? "\\\"" : std::string(1, c);
    return "json_extract(c.levels_json, " + quotedText("$.\"" + key + "\"") + ")";
}

std::string measureSql(const std::string& measure) {
    return "(SELECT x.value_num FROM attempt_measure x WHERE x.attempt_id=a.attempt_id AND x.measure=" +
           quotedText(measure) + ")";
}

constexpr const char* kDocument = "column_doc";
constexpr std::string_view kMarkEnd = " */ ";
constexpr std::size_t kMarkDigits = 16;

std::string markStart(const std::string& name) { return "CREATE VIEW " + name + " AS /* "; }

/// The statement with the beginning of its own SHA-256: unlike those of tables it is another one in each study, and no
/// other text tells whether it is as it was written.
std::string withMark(const std::string& name, const std::string& select) {
    return markStart(name) + sha256Hex(select).substr(0, kMarkDigits) + std::string(kMarkEnd) + select;
}

class ViewMaker {
public:
    explicit ViewMaker(StudyColumns study) : study_(std::move(study)) {}

    std::string viewSql(const ViewText& view) const {
        std::string columns;
        const auto add = [&](const std::string& sql, const std::string& name) {
            columns += (columns.empty() ? "" : ", ") + sql + " AS " + quotedName(name);
        };
        for (const ViewColumn& column : view.columns) {
            if (column.name == view.factors_before)
                for (const StudyFactor& factor : study_.factors) add(factorSql(factor), factorColumn(factor, view));
            if (column.name == view.measures_before)
                for (const std::string& measure : study_.measures) add(measureSql(measure), measure);
            add(column.in_view.empty() ? column.sql : column.in_view, column.name);
        }
        return withMark(view.name, view.with + "SELECT " + columns + " " + view.from);
    }

    /// Fixed columns and factors as they are; measures by what the database says of them.
    std::string documentSql() const {
        std::string rows;
        const auto add = [&](const std::string& view, const std::string& name, const std::string& label,
                             const std::string& unit, const std::string& formula, int version) {
            rows += (rows.empty() ? "(" : ", (") + quotedText(view) + ", " + quotedText(name) + ", " +
                    quotedText(label) + ", " + quotedText(unit) + ", " + quotedText(formula) + ", " +
                    std::to_string(version) + ")";
        };
        std::string of_measures;
        for (const StudyView which : kStudyViews) {
            const ViewText& view = textOf(which);
            for (const ViewColumn& column : view.columns) {
                if (column.name == view.factors_before)
                    for (const StudyFactor& factor : study_.factors)
                        add(view.name, factorColumn(factor, view), "Factor " + factor.name + " (" + factor.kind + ")",
                            factor.unit, "", 1);
                add(view.name, column.name, column.label, column.unit, column.formula, column.formula_version);
            }
            if (!view.measures_before.empty())
                of_measures += " UNION ALL SELECT " + quotedText(view.name) +
                               ", measure, label, CASE unit WHEN '1' THEN '' ELSE unit END, formula, formula_version " +
                               kMeasures;
        }
        return withMark(kDocument,
                        "WITH doc(view_name, column_name, label, unit, formula, formula_version) AS (VALUES" + rows +
                            of_measures + ") SELECT * FROM doc");
    }

private:
    /// As exports name it: with "factor_" before it where that is another column's name.
    std::string factorColumn(const StudyFactor& factor, const ViewText& view) const {
        // of staircase.csv, which no view is
        static const std::set<std::string> others = {"wanted_level", "level", "positive", "reversal"};
        const auto has = [&](const ViewText& text) {
            return std::any_of(text.columns.begin(), text.columns.end(),
                               [&](const ViewColumn& column) { return column.name == factor.name; });
        };
        const bool of_staircases = has(textOf(StudyView::Thresholds)) || others.count(factor.name) != 0;
        const auto& measures = study_.measures;
        const bool taken = has(view) || has(textOf(StudyView::Trials)) || (study_.staircases && of_staircases) ||
                           std::find(measures.begin(), measures.end(), factor.name) != measures.end();
        return taken ? "factor_" + factor.name : factor.name;
    }

    StudyColumns study_;
};

void makeView(const Database& database, const StudyViewText& view) {
    {
        Statement known = database.prepare("SELECT type, sql FROM main.sqlite_schema WHERE name=?");
        known.bind(view.name);
        if (known.step()) {
            if (known.text(0) != "view" || known.text(1) == view.sql) return;  // a table of that name is somebody's own
            known.reset();
            database.execute("DROP VIEW main." + view.name);
        }
    }
    database.execute(view.sql);
}

}  // namespace

std::vector<StudyViewText> studyViewTexts(const Database& database) {
    // A plan that is damaged has none, and is no reason to have no views.
    const bool staircases =
        database.integer(
            "SELECT EXISTS(SELECT 1 FROM protocol_version, json_each(CASE WHEN json_valid(expanded_json) THEN "
            "expanded_json ELSE '{}' END, '$.staircases'))") != 0;
    const ViewMaker maker({readFactors(database), readMeasures(database), staircases});
    std::vector<StudyViewText> views;
    for (const StudyView view : kStudyViews) views.push_back({textOf(view).name, maker.viewSql(textOf(view))});
    views.push_back({kDocument, maker.documentSql()});
    return views;
}

void makeStudyViews(const Database& database) {
    for (const StudyViewText& view : studyViewTexts(database)) makeView(database, view);
}

bool isStudyView(const std::string& name) {
    return name == kDocument || std::any_of(kStudyViews.begin(), kStudyViews.end(),
                                            [&](StudyView view) { return textOf(view).name == name; });
}

bool isAsWritten(const StudyViewText& view) {
    const std::size_t digits = markStart(view.name).size(), select = digits + kMarkDigits + kMarkEnd.size();
    return view.sql.size() > select && view.sql == withMark(view.name, view.sql.substr(select));
}

std::optional<std::string> markedName(const std::string& sql) {
    for (const StudyView view : kStudyViews)
        if (sql.starts_with(markStart(textOf(view).name))) return textOf(view).name;
    return sql.starts_with(markStart(kDocument)) ? std::optional<std::string>(kDocument) : std::nullopt;
}

}  // namespace passung::store
