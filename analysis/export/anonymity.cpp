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

void Anonymiser::note(Entry entry) {
    if (entry.cells > 0) entries_.push_back(std::move(entry));
}

int Anonymiser::weeksOf(const std::string& participant) {
    const auto [found, is_new] = weeks_.try_emplace(participant, 0);
    if (is_new) found->second = 1 + static_cast<int>(random_.below(kMostWeeks));
    return found->second;
}

Anonymiser::Work::Work(Anonymiser& owner, const Table& table)
    : owner_(owner), file_(table.file), code_(placeOf(table, "participant_id")), kind_(placeOf(table, "kind")) {
    if (!code_) return;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const Column& column = table.columns[i];
        if (column.type == "time")
            cells_.push_back({i, true, {file_, column.name, "set back by whole weeks, each person's own number", {}}});
        if (column.typed) cells_.push_back({i, false, {file_, column.name, "text left out", {}}});
    }
    const auto questionnaire = placeOf(table, "questionnaire"), item = placeOf(table, "item"),
               value = placeOf(table, "value");
    if (!questionnaire || !item || !value) return;
    items_ = Items{*questionnaire, *item, *value};
    for (const Band& band : owner.how_.bands)
        bands_.push_back({file_, "value", fmt::format("low end of its range of {}", band.width), band.item});
}

bool Anonymiser::Work::hasPerson(const TableRow& row) const { return !(kind_ && row[*kind_] == "simulated"); }

void Anonymiser::Work::change(TableRow& row) {
    for (Cells& cells : cells_) {
        std::string& text = row[cells.column];
        if (!hasPerson(row) || text.empty() || text == kMissing) continue;
        std::string rest =
            cells.times ? weeksBefore(text, owner_.weeksOf(row[*code_])) : withoutTyped(cells.entry.column, text);
        if (cells.times || rest != text) ++cells.entry.cells;
        text = std::move(rest);
    }
    if (!items_) return;
    tellInBands(row);
    countAnswer(row);
}

void Anonymiser::Work::tellInBands(TableRow& row) {
    for (std::size_t i = 0; i < bands_.size(); ++i) {
        const Band& band = owner_.how_.bands[i];
        if (items_->nameIn(row) != band.item) continue;
        owner_.used_.insert(band.item);
        const auto value = numberIn(row[items_->value]);
        if (!hasPerson(row) || !value) continue;
        row[items_->value] = cell(band.width * std::floor(*value / band.width));
        ++bands_[i].cells;
    }
}

void Anonymiser::Work::countAnswer(const TableRow& row) {
    if (!hasPerson(row)) return;
    const std::string item = items_->nameIn(row);
    if (!answered_[item].insert(row[*code_]).second) often_.insert(item);
    if (numberIn(row[items_->value])) by_answer_[item][row[items_->value]].insert(row[*code_]);
}

void Anonymiser::Work::end() {
    for (Cells& cells : cells_) owner_.note(std::move(cells.entry));
    for (Entry& band : bands_) owner_.note(std::move(band));
    for (const auto& [item, answers] : by_answer_) {
        if (often_.contains(item)) continue;
        for (const auto& [answer, who] : answers) {
            const auto count = static_cast<std::int64_t>(who.size());
            const auto least = owner_.how_.least_persons;
            if (count < least)
                owner_.note({file_, "value", fmt::format("answer of fewer than {} persons: kept, look at it", least),
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
