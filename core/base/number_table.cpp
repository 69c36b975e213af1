#include "core/base/number_table.h"

#include <charconv>
#include <sstream>
#include <string_view>

#include "core/base/regular_file.h"

namespace passung {

namespace {

constexpr std::uintmax_t kMostTableBytes = std::uintmax_t{256} << 20;
constexpr std::size_t kMostFaults = 1000;  // then reading ends: the rest is hardly better

/// Length of the cell that `line` begins with: up to the next comma that is not within quotes.
std::size_t cellLength(std::string_view line) {
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"') quoted = !quoted;  // a doubled quote inside opens and closes again
        if (line[i] == ',' && !quoted) return i;
    }
    return line.size();
}

std::vector<std::string_view> cells(std::string_view line) {
    std::vector<std::string_view> result;
    for (;;) {
        const std::size_t length = cellLength(line);
        result.push_back(line.substr(0, length));
        if (length == line.size()) return result;
        line.remove_prefix(length + 1);
    }
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
}

/// The whole cell as a number; a leading plus is understood.
bool readNumber(std::string_view text, double& value) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    return problem == std::errc() && end == text.data() + text.size();
}

bool readLine(std::istream& file, std::string& line) {
    if (!std::getline(file, line)) return false;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return true;
}

std::string joined(const std::vector<std::string>& texts) {
    std::string line;
    for (std::size_t i = 0; i < texts.size(); ++i) line += (i == 0 ? "" : ",") + texts[i];
    return line;
}

/// What to add to a message about a line that has too few cells.
std::string commasExpected(const std::string& line) {
    return line.find(';') == std::string::npos ? "" : ", parted by commas, not by semicolons";
}

/// Reads the rows below the header.
class RowReader {
public:
    RowReader(const std::string& path, std::size_t numbers, NumberTable& table)
        : path_(path), numbers_(numbers), table_(table) {}

    void read(const std::string& line, int number) {
        const auto row = cells(line);
        if (row.size() != table_.columns.size()) {
            errors.push_back(
                {.message = "a row needs " + std::to_string(table_.columns.size()) + " values" + commasExpected(line),
                 .file = path_,
                 .line = number,
                 .column = 1,
                 .value = std::to_string(row.size())});
            return;
        }
        std::vector<double> values(numbers_);
        std::vector<std::string> texts;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string_view text = trimmed(row[i]);
            texts.emplace_back(text);
            if (i >= numbers_ || readNumber(text, values[i])) continue;
            errors.push_back({.message = "must be a number",
                              .file = path_,
                              .line = number,
                              .column = static_cast<int>(row[i].data() - line.data()) + 1,
                              .key = table_.columns[i],
                              .value = std::string(text)});
        }
        table_.rows.push_back(std::move(values));
        table_.texts.push_back(std::move(texts));
        table_.lines.push_back(number);
    }

    Errors errors;

private:
    const std::string& path_;
    std::size_t numbers_;
    NumberTable& table_;
};

}  // namespace

std::string NumberTable::headerLine() const { return joined(columns); }

std::string NumberTable::rowLine(std::size_t row) const { return joined(texts[row]); }

Result<NumberTable> readNumbers(const std::string& path, const std::vector<std::string>& required) {
    auto text = readRegularFile(path, kMostTableBytes);
    if (!text) return text.errors();
    std::istringstream file(std::move(*text));
    std::string line;
    if (!readLine(file, line)) return Error{.message = "is empty; a header row is required", .file = path};
    if (line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);  // the byte order mark that spreadsheets write
    NumberTable table;
    for (const auto name : cells(line)) table.columns.emplace_back(trimmed(name));
    for (std::size_t i = 0; i < required.size(); ++i) {
        if (i < table.columns.size() && table.columns[i] == required[i]) continue;
        return Error{.message = "the header must be " + joined(required) +
                                " (further columns may follow): its column " + std::to_string(i + 1) + " must be " +
                                required[i] + commasExpected(line),
                     .file = path,
                     .line = 1,
                     .column = 1,
                     .value = i < table.columns.size() ? table.columns[i] : "missing"};
    }
    RowReader reader(path, required.size(), table);
    for (int number = 2; reader.errors.size() < kMostFaults && readLine(file, line); ++number) {
        if (!trimmed(line).empty()) reader.read(line, number);
    }
    if (!reader.errors.empty()) return reader.errors;
    if (table.rows.empty()) return Error{.message = "has no rows", .file = path};
    return table;
}

Errors firstFaults(Errors errors) {
    constexpr std::size_t kShown = 5;
    if (errors.size() <= kShown) return errors;
    const std::size_t more = errors.size() - kShown;
    errors.resize(kShown);
    errors.back().message += "; " + std::to_string(more) + " more rows are wrong";
    return errors;
}

}  // namespace passung
