#include "study/protocol/condition_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/json.h"

namespace passung::protocol {
namespace {

struct Row {
    std::vector<std::string> cells;
    int line = 1;
};

/// Spaces around a cell are none of a label.
std::string trimmed(const std::string& text) {
    const auto begin = text.find_first_not_of(" \t");
    return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// Reads cell by cell; rows without any text are left out.
class CsvRows {
public:
    explicit CsvRows(const std::string& text) : text_(text) {
        if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // a byte order mark, as spreadsheets write it
    }

    /// False where a quoted cell is wrong: problem().
    bool read(std::vector<Row>& rows) {
        while (at_ < text_.size()) {
            Row row{{}, line_};
            if (!readRow(row)) return false;
            if (row.cells.size() > 1 || !row.cells[0].empty()) rows.push_back(std::move(row));
        }
        return true;
    }
    int line() const { return line_; }
    const std::string& problem() const { return problem_; }

private:
    bool fails(const char* problem) {
        problem_ = problem;
        return false;
    }

    bool readRow(Row& row) {
        for (;;) {
            row.cells.emplace_back();
            if (!readCell(row.cells.back())) return false;
            if (at_ >= text_.size()) return true;
            const char end = text_[at_++];
            if (end == ',') continue;
            ++line_;
            return true;
        }
    }

    /// Up to the comma or line break that ends it.
    bool readCell(std::string& cell) {
        const auto start = text_.find_first_not_of(" \t", at_);
        const bool quoted = start != std::string::npos && text_[start] == '"';
        if (!quoted) {
            const auto end = std::min(text_.find_first_of(",\n", at_), text_.size());
            cell = text_.substr(at_, end - at_);
            at_ = end;
            if (cell.ends_with('\r')) cell.pop_back();
            cell = trimmed(cell);
            return true;
        }
        for (at_ = start + 1; at_ < text_.size(); ++at_) {
            if (text_[at_] == '\n') ++line_;
            if (text_[at_] != '"') {
                cell += text_[at_];
            } else if (at_ + 1 < text_.size() && text_[at_ + 1] == '"') {
                cell += text_[at_++];
            } else {
                const auto end = std::min(text_.find_first_of(",\n", at_), text_.size());
                if (text_.find_first_not_of(" \t\r", at_ + 1) < end) return fails("nothing may follow a quoted cell");
                at_ = end;
                return true;
            }
        }
        return fails("a quoted cell does not end");
    }

    const std::string& text_;
    std::size_t at_ = 0;
    int line_ = 1;
    std::string problem_;
};

Error wrong(const std::string& path, int line, std::string message) {
    return errorAt({path, line, 1}, "conditions", "", std::move(message));
}

}  // namespace

Result<std::vector<ListedLine>> conditionLines(const std::string& csv, const std::string& path,
                                               const std::string& name) {
    std::vector<Row> rows;
    CsvRows reader(csv);
    if (!reader.read(rows)) return wrong(path, reader.line(), reader.problem());
    if (rows.empty()) return wrong(path, 1, "is empty: the first row must name factors");
    if (rows.size() == 1) return wrong(path, 1, "has no row of levels");
    const auto& header = rows.front().cells;
    std::vector<ListedLine> lines{{fmt::format("conditions = [  # {} begins", name), rows.front().line}};
    for (std::size_t r = 1; r < rows.size(); ++r) {
        const auto& cells = rows[r].cells;
        if (cells.size() != header.size())
            return wrong(path, rows[r].line,
                         fmt::format("has {} cells, the first row {}", cells.size(), header.size()));
        std::string text;
        for (std::size_t i = 0; i < cells.size(); ++i)
            text += (i > 0 ? ", " : "") + jsonText(header[i]) + " = " + jsonText(cells[i]);
        lines.push_back({"  { " + text + " },", rows[r].line});
    }
    lines.push_back({fmt::format("]  # {} ends", name), rows.back().line});
    return lines;
}

}  // namespace passung::protocol
