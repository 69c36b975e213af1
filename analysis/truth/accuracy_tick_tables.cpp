#include "analysis/truth/accuracy_tick_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/truth/accuracy_tables.h"
#include "analysis/truth/item_columns.h"
#include "core/scene/contact_geometry.h"

namespace passung::truth {

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

using Row = PathCost;
using Columns = std::vector<ItemColumn<Row>>;

bool isOfFields(const Row& row) { return row.setting.geometry == scene::Geometry::Field; }

/// Of settings that only fields have.
template <class Text>
auto ofFields(const Text& text) {
    return [text](const Row& row) { return isOfFields(row) ? std::string(text(row)) : std::string("NA"); };
}

void addSettings(Columns& columns) {
    columns.insert(
        columns.end(),
        {{"method", "", "contact.method",
          [](const Row& r) { return std::string(scene::methodName(r.setting.method)); }},
         {"geometry", "", "contact.geometry",
          [](const Row& r) { return std::string(scene::geometryName(r.setting.geometry)); }},
         {"tolerance_um", "um", "contact.tolerance_um, of fields; NA: has no meaning there",
          ofFields([](const Row& r) { return cell(1e6 * r.setting.field.tolerance); })},
         {"spacing_mm", "mm", "contact.spacing_mm, likewise",
          ofFields([](const Row& r) { return cell(1e3 * r.setting.field.spacing); })},
         {"mode", "", "contact.mode, likewise",
          ofFields([](const Row& r) { return field::modeName(r.setting.field.mode); })},
         {"two_way", "", "contact.two_way, likewise",
          ofFields([](const Row& r) { return r.setting.two_way ? "1" : "0"; })},
         {"budget_nodes", "", "contact.budget_nodes, likewise; 0: no limit",
          ofFields([](const Row& r) { return std::to_string(r.setting.field.budget_nodes); })},
         {"points", "", "of the held part, likewise", ofFields([](const Row& r) { return std::to_string(r.points); })},
         {"memory_MB", "MB", "of fields and points; of clusters of triangles; of faces and edges",
          [](const Row& r) { return cell(1e-6 * r.bytes); }}});
}

void addTimes(Columns& columns, const std::string& name, const std::string& meaning, TickSpread Row::*spread) {
    const auto add = [&](const char* what, const char* words, double TickSpread::*value) {
        columns.push_back(
            {name + what, "us", words + meaning, [=](const Row& row) { return cell(1e6 * (row.*spread.*value)); }});
    };
    add("_median_us", "median over ticks of ", &TickSpread::median);
    add("_p999_us", "99.9th percentile (nearest rank) over ticks of ", &TickSpread::p999);
    add("_max_us", "largest over ticks of ", &TickSpread::max);
}

void addSpread(Columns& columns, const std::string& name, const std::string& unit, const std::string& meaning,
               double factor, Spread Row::*spread) {
    const auto add = [&](const char* what, const char* words, double Spread::*value) {
        columns.push_back({name + "_" + what + "_" + unit, unit, words + meaning,
                           [=](const Row& row) { return cell(factor * (row.*spread.*value)); }});
    };
    add("median", "median over ticks of ", &Spread::median);
    add("p99", "99th percentile (nearest rank) over ticks of ", &Spread::p99);
    add("max", "largest over ticks of ", &Spread::max);
}

void addTruth(Columns& columns) {
    columns.insert(
        columns.end(),
        {{"ticks", "", "of the path", [](const Row& r) { return std::to_string(r.ticks); }},
         {"suspended", "", "ticks whose work went on in the next one",
          [](const Row& r) { return std::to_string(r.suspended); }},
         {"suspended_in_a_row", "", "most of them in a row",
          [](const Row& r) { return std::to_string(r.suspended_in_a_row); }},
         {"recorded_overlap_max_um", "um", "largest overlap of the shown part that the ticks themselves record",
          [](const Row& r) { return cell(1e6 * r.recorded); }},
         {"judged_ticks", "", "ticks whose true overlap was measured",
          [](const Row& r) { return std::to_string(r.judged); }},
         {"overlap_max_um", "um",
          "largest true overlap of the shown part in them, by exact geometry (round shapes as triangles to 0.1 um, "
          "balls and rings to 0.5 um): "
          "found",
          [](const Row& r) { return cell(1e6 * r.overlap); }},
         {"overlap_bound_um", "um", "what it is not above in any of them: proven",
          [](const Row& r) { return cell(1e6 * r.overlap_bound); }},
         {"referenced_ticks", "", "judged ticks with a force to compare with",
          [](const Row& r) { return std::to_string(r.referenced); }},
         {"force_error_max_N", "N",
          "largest | |F| - |F_ref| | in them; F: of the spring alone, F_ref: of a spring to the pose of least energy "
          "without overlap, by closed forms apart from the program's",
          [](const Row& r) { return cell(r.force_error); }}});
    addSpread(columns, "force_error", "percent",
              "| |F| - |F_ref| | / |F_ref|, where |F_ref| is at least 1 % of the largest one", 100.0, &Row::force);
    addSpread(columns, "direction_error", "deg", "angle between F and F_ref at the same ticks", kDegrees,
              &Row::direction);
    const char* grain =
        "change of the spring's force from tick to tick beyond stiffness times the hand's motion in between, which is "
        "the most that convex free space asks for";
    columns.push_back({"grain_p999_N", "N", std::string("99.9th percentile (nearest rank) over ticks of the ") + grain,
                       [](const Row& r) { return cell(r.grain.p999); }});
    columns.push_back(
        {"grain_max_N", "N", std::string("largest ") + grain, [](const Row& r) { return cell(r.grain.max); }});
    columns.push_back(
        {"on_overlap_front", "",
         "1: no other row is as fast (time_p999_us) and as near the truth (overlap_bound_um), and better in one",
         [](const Row& r) { return std::string(r.on_overlap_front ? "1" : "0"); }});
    columns.push_back({"on_force_front", "", "1: the same with force_error_p99_percent",
                       [](const Row& r) { return std::string(r.on_force_front ? "1" : "0"); }});
}

Columns rowColumns() {
    Columns columns;
    addSettings(columns);
    addTimes(columns, "time", "a tick's time on its processor, the least of all runs of the same path", &Row::time);
    addTimes(columns, "wall", "the same by the wall clock", &Row::wall);
    addTruth(columns);
    return columns;
}

}  // namespace

std::string tickCsv(const TickAccuracy& result) { return csv(rowColumns(), result.rows); }

std::string tickCodebook() { return kCodebookHeader + codebookOf("accuracy.csv", rowColumns()); }

std::string settingText(const TickSetting& setting) {
    const std::string text =
        fmt::format("{}, {}", scene::methodName(setting.method), scene::geometryName(setting.geometry));
    if (setting.geometry != scene::Geometry::Field) return text;
    return fmt::format("{}, {}{}", text, settingText(setting.field), setting.two_way ? ", two ways" : "");
}

std::string tickText(const TickAccuracy& result) {
    std::vector<const Row*> order;
    for (const Row& row : result.rows) order.push_back(&row);
    std::stable_sort(order.begin(), order.end(),
                     [](const Row* a, const Row* b) { return a->time.p999 < b->time.p999; });
    std::string text = fmt::format("{:>10} {:>10} {:>12} {:>14} {:>9} {:>9} {:>9}   {}\n", "time", "p99.9", "overlap",
                                   "proven below", "force", "grain", "suspended", "setting");
    for (const Row* row : order) {
        const std::string force =
            std::isnan(row->force.p99) ? std::string("NA") : fmt::format("{:.2g} %", 100.0 * row->force.p99);
        text += fmt::format("{:>7.1f} µs {:>7.1f} µs {:>9.2f} µm {:>11.2f} µm {:>9} {:>7.2g} N {:>9} {}{} {}\n",
                            1e6 * row->time.median, 1e6 * row->time.p999, 1e6 * row->overlap, 1e6 * row->overlap_bound,
                            force, row->grain.max, row->suspended, row->on_overlap_front ? "o" : " ",
                            row->on_force_front ? "f" : " ", settingText(row->setting));
    }
    text +=
        "o, f: no other setting is both faster (p99.9) and nearer the truth, in overlap (its proven bound), in force "
        "(p99)\n";
    for (const std::string& note : result.notes) text += note + "\n";
    return text;
}

}  // namespace passung::truth
