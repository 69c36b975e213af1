#pragma once

#include <stdexcept>
#include <string>
#include <vector>

/// A reader of RFC 4180 for tests, written from the RFC and not from the writer: character by character, with states.
namespace passung::fake {

struct CsvFile {
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;

    /// The cell of `row` in the column `name`; fails the test by an exception if there is none.
    const std::string& at(std::size_t row, const std::string& name) const {
        for (std::size_t i = 0; i < header.size(); ++i) {
            if (header[i] == name) return rows.at(row).at(i);
        }
        throw std::runtime_error("no column " + name);
    }
    bool has(const std::string& name) const {
        for (const std::string& column : header) {
            if (column == name) return true;
        }
        return false;
    }
};

/// Throws for anything the RFC does not allow, and for rows whose length differs from the header's.
inline CsvFile readCsv(const std::string& text) {
    enum class State { FieldStart, Plain, Quoted, QuoteInQuoted };
    State state = State::FieldStart;
    std::vector<std::vector<std::string>> lines;
    std::vector<std::string> line;
    std::string field;
    const auto endField = [&] {
        line.push_back(field);
        field.clear();
        state = State::FieldStart;
    };
    const auto endLine = [&] {
        endField();
        lines.push_back(line);
        line.clear();
    };
    for (const char c : text) {
        switch (state) {
            case State::FieldStart:
            case State::Plain:
                if (c == '"') {
                    if (state == State::Plain) throw std::runtime_error("quote inside a plain field");
                    state = State::Quoted;
                } else if (c == ',') {
                    endField();
                } else if (c == '\n') {
                    endLine();
                } else if (c == '\r') {
                    throw std::runtime_error("carriage return outside quotes");
                } else {
                    field += c;
                    state = State::Plain;
                }
                break;
            case State::Quoted:
                if (c == '"') {
                    state = State::QuoteInQuoted;
                } else {
                    field += c;
                }
                break;
            case State::QuoteInQuoted:
                if (c == '"') {
                    field += c;
                    state = State::Quoted;
                } else if (c == ',') {
                    endField();
                } else if (c == '\n') {
                    endLine();
                } else {
                    throw std::runtime_error("text after a closing quote");
                }
                break;
        }
    }
    if (state != State::FieldStart || !line.empty()) throw std::runtime_error("the last line does not end");
    CsvFile file;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (lines[i].size() != lines[0].size())
            throw std::runtime_error("row " + std::to_string(i) + " has another length");
        if (i > 0) file.rows.push_back(lines[i]);
    }
    if (!lines.empty()) file.header = lines[0];
    return file;
}

}  // namespace passung::fake
