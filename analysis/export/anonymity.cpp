#include "analysis/export/anonymity.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <optional>
#include <string_view>

#include "analysis/export/columns.h"

namespace passung::exporter {
namespace {

constexpr int kMostWeeks = 52;

std::optional<double> numberIn(std::string_view text) {
    double number = 0.0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

std::optional<std::size_t> placeOf(const Table& table, std::string_view name) {
    const auto found = std::find_if(table.columns.begin(), table.columns.end(),
                                    [&](const Column& column) { return column.name == name; });
    if (found == table.columns.end()) return std::nullopt;
    return static_cast<std::size_t>(found - table.columns.begin());
}

/// A time of ISO 8601 so many weeks earlier; NA if it does not begin with a date.
std::string weeksBefore(const std::string& time, int weeks) {
    using namespace std::chrono;
    int year_number = 0;
    unsigned month_number = 0, day_number = 0;
    const auto read = [&time](std::size_t at, std::size_t length, auto& number) {
        const char* begin = time.data() + at;
        const auto [end, problem] = std::from_chars(begin, begin + length, number);
        return problem == std::errc() && end == begin + length;
    };
    if (time.size() < 10 || !read(0, 4, year_number) || !read(5, 2, month_number) || !read(8, 2, day_number))
        return kMissing;
    const sys_days day = year(year_number) / month(month_number) / std::chrono::day(day_number);
    const year_month_day earlier(day - days(7 * weeks));
    return fmt::format("{:04}-{:02}-{:02}{}", static_cast<int>(earlier.year()), static_cast<unsigned>(earlier.month()),
                       static_cast<unsigned>(earlier.day()), time.substr(10));
}

/// JSON without a text in it.
bool tellsNumbersOnly(const std::string& json) {
    for (std::size_t at = 0; (at = json.find('"', at)) != std::string::npos; ++at) {
        const std::size_t end = json.find('"', at + 1);
        if (end == std::string::npos || end + 1 >= json.size() || json[end + 1] != ':') return false;
        at = end;
    }
    return true;
}

/// What stays of a text that may hold what somebody typed.
std::string withoutTyped(const std::string& column, const std::string& text) {
    constexpr std::string_view kReasonFollows = "not valid: ";
    if (column == "payload_json" && tellsNumbersOnly(text)) return text;
    if (text.starts_with(kReasonFollows)) return std::string(kReasonFollows.substr(0, kReasonFollows.find(':')));
    return column == "not_counted_because" ? text : kMissing;
}

struct Items {
    std::size_t questionnaire, item, value;

    std::string nameIn(const std::vector<std::string>& row) const { return row[questionnaire] + '.' + row[item]; }
};

/// Of the table of answers, if this is it.
std::optional<Items> itemsOf(const Table& table) {
    const auto questionnaire = placeOf(table, "questionnaire"), item = placeOf(table, "item"),
               value = placeOf(table, "value");
    if (!questionnaire || !item || !value) return std::nullopt;
    return Items{*questionnaire, *item, *value};
}

}  // namespace

Result<Band> readBand(const std::string& text) {
    const std::size_t equals = text.find('=');
    const auto width = equals == std::string::npos ? std::nullopt : numberIn(text.substr(equals + 1));
    const std::string item = text.substr(0, equals);
    if (!width || !std::isfinite(*width) || *width <= 0.0 || item.find('.') == std::string::npos)
        return Error{
            .message = "must be QUESTIONNAIRE.ITEM=WIDTH with a width above 0", .key = "--band", .value = text};
    return Band{item, *width};
}

/// Whom the rows are of; nobody in tables about no persons.
struct Anonymiser::Persons {
    explicit Persons(const Table& table) : code(placeOf(table, "participant_id")), kind(placeOf(table, "kind")) {}

    bool has(const std::vector<std::string>& row) const { return code && !(kind && row[*kind] == "simulated"); }
    const std::string& of(const std::vector<std::string>& row) const { return row[*code]; }

    std::optional<std::size_t> code, kind;
};

void Anonymiser::apply(Table& table) {
    const Persons persons(table);
    if (!persons.code) return;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        if (table.columns[i].type == "time") setBack(table, i, persons);
        if (table.columns[i].typed) leaveOut(table, i, persons);
    }
    tellInBands(table, persons);
    listSmallCells(table, persons);
}

void Anonymiser::note(Entry entry) {
    if (entry.cells > 0) entries_.push_back(std::move(entry));
}

int Anonymiser::weeksOf(const std::string& participant) {
    const auto [found, is_new] = weeks_.try_emplace(participant, 0);
    if (is_new) found->second = 1 + static_cast<int>(random_.below(kMostWeeks));
    return found->second;
}

void Anonymiser::setBack(Table& table, std::size_t column, const Persons& persons) {
    Entry entry{table.file, table.columns[column].name, "set back by whole weeks, each person's own number", {}};
    for (auto& row : table.rows) {
        if (!persons.has(row) || row[column].empty() || row[column] == kMissing) continue;
        row[column] = weeksBefore(row[column], weeksOf(persons.of(row)));
        ++entry.cells;
    }
    note(std::move(entry));
}

void Anonymiser::leaveOut(Table& table, std::size_t column, const Persons& persons) {
    Entry entry{table.file, table.columns[column].name, "text left out", {}};
    for (auto& row : table.rows) {
        if (!persons.has(row) || row[column].empty() || row[column] == kMissing) continue;
        std::string rest = withoutTyped(entry.column, row[column]);
        if (rest != row[column]) ++entry.cells;
        row[column] = std::move(rest);
    }
    note(std::move(entry));
}

void Anonymiser::tellInBands(Table& table, const Persons& persons) {
    const auto items = itemsOf(table);
    if (!items) return;
    for (const Band& band : how_.bands) {
        Entry entry{table.file, "value", fmt::format("low end of its range of {}", band.width), band.item};
        for (auto& row : table.rows) {
            if (items->nameIn(row) != band.item) continue;
            used_.insert(band.item);
            const auto value = numberIn(row[items->value]);
            if (!persons.has(row) || !value) continue;
            row[items->value] = cell(band.width * std::floor(*value / band.width));
            ++entry.cells;
        }
        note(std::move(entry));
    }
}

/// Of items that each person answered once: others are about trials and conditions, not about persons.
void Anonymiser::listSmallCells(const Table& table, const Persons& persons) {
    const auto items = itemsOf(table);
    if (!items) return;
    std::map<std::string, std::map<std::string, std::set<std::string>>> by_answer;  // who, by item and answer
    std::map<std::string, std::set<std::string>> answered;
    std::set<std::string> often;
    for (const auto& row : table.rows) {
        if (!persons.has(row)) continue;
        const std::string item = items->nameIn(row);
        if (!answered[item].insert(persons.of(row)).second) often.insert(item);
        if (numberIn(row[items->value])) by_answer[item][row[items->value]].insert(persons.of(row));
    }
    for (const auto& [item, answers] : by_answer) {
        if (often.contains(item)) continue;
        for (const auto& [answer, who] : answers) {
            const auto count = static_cast<std::int64_t>(who.size());
            if (count < how_.least_persons)
                note({table.file, "value",
                      fmt::format("answer of fewer than {} persons: kept, look at it", how_.least_persons),
                      fmt::format("{}={}", item, answer), count});
        }
    }
}

Table Anonymiser::account() const {
    const ColumnsOf<Entry> columns = {
        {"file", "Table", "text", &Entry::file},
        {"column", "Its column", "text", &Entry::column},
        {"what", "What was done with it, or what is to be looked at", "text", &Entry::what},
        {"value", "QUESTIONNAIRE.ITEM, and the answer if it is about one", "text", &Entry::value},
        {"cells", "Number of cells; of an answer the number of persons", "integer", &Entry::cells}};
    return makeTable("anonymity.csv",
                     "**What was taken out to hide persons**, and answers that few of them gave. Codes of participants "
                     "are as in the lab's list.",
                     columns, entries_);
}

std::vector<std::string> Anonymiser::unusedBands() const {
    std::vector<std::string> unused;
    for (const Band& band : how_.bands)
        if (!used_.contains(band.item)) unused.push_back(band.item);
    return unused;
}

}  // namespace passung::exporter
