#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analysis/export/table.h"
#include "core/base/random.h"
#include "core/base/result.h"

namespace passung::exporter {

/// Answers to an item of a questionnaire told as ranges.
struct Band {
    std::string item;    // as QUESTIONNAIRE.ITEM
    double width = 1.0;  // an answer becomes the low end of its range, a multiple of this
};

/// From "demographics.age=10".
Result<Band> readBand(const std::string& text);

/// How an export for others than the lab hides persons. Their codes stay: who has the list of codes and names knows
/// them.
struct Anonymity {
    std::vector<Band> bands;
    std::int64_t least_persons = 5;  // answers of fewer persons are listed: they point to somebody
    std::uint64_t seed = 0;          // of the weeks; to be forgotten, or the dates come back
};

/// Takes out of the tables of an export what persons may be known by, and keeps account of it: their times are set back
/// by a number of whole weeks that each person has for himself, texts that somebody typed are left out. Simulated
/// participants stay as they are.
class Anonymiser {
    struct Entry {
        std::string file, column, what, value;
        std::int64_t cells = 0;
    };

public:
    explicit Anonymiser(Anonymity how) : how_(std::move(how)), random_(how_.seed) {}

    /// A table at work. Belongs to its anonymiser.
    class Work {
    public:
        /// For each row of the table, once and in order.
        void change(TableRow& row);
        /// After the last row: takes what was done to account.
        void end();

    private:
        friend class Anonymiser;
        Work(Anonymiser& owner, const Table& table);
        /// A column's cells that are times to set back, or texts that somebody typed.
        struct Cells {
            std::size_t column;
            bool times;
            Entry entry;
        };
        struct Items {
            std::size_t questionnaire, item, value;

            std::string nameIn(const TableRow& row) const { return row[questionnaire] + '.' + row[item]; }
        };
        bool hasPerson(const TableRow& row) const;  // @pre code_
        void tellInBands(TableRow& row);
        void countAnswer(const TableRow& row);

        Anonymiser& owner_;
        std::string file_;
        std::optional<std::size_t> code_, kind_;  // columns; no code: the table is about no persons
        std::vector<Cells> cells_;
        std::optional<Items> items_;  // of the table of answers
        std::vector<Entry> bands_;    // as the owner's
        // Who, by item and answer, of items that each person answered once: others are about trials and conditions.
        std::map<std::string, std::map<std::string, std::set<std::string>>> by_answer_;
        std::map<std::string, std::set<std::string>> answered_;
        std::set<std::string> often_;
    };
    Work begin(const Table& table) { return {*this, table}; }
    /// What was changed, and which answers point to somebody: a row for each column, or answer.
    Table account() const;
    /// Bands of items that no table had.
    std::vector<std::string> unusedBands() const;

private:
    void note(Entry entry);
    int weeksOf(const std::string& participant);

    Anonymity how_;
    Random random_;
    std::map<std::string, int> weeks_;  // by participant
    std::set<std::string> used_;        // items in bands
    std::vector<Entry> entries_;
};

}  // namespace passung::exporter
