#pragma once

#include <cstdint>
#include <map>
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
public:
    explicit Anonymiser(Anonymity how) : how_(std::move(how)), random_(how_.seed) {}

    void apply(Table& table);
    /// What was changed, and which answers point to somebody: a row for each column, or answer.
    Table account() const;
    /// Bands of items that no table had.
    std::vector<std::string> unusedBands() const;

private:
    struct Entry {
        std::string file, column, what, value;
        std::int64_t cells = 0;
    };
    struct Persons;  // of the table at hand

    void setBack(Table& table, std::size_t column, const Persons& persons);
    void leaveOut(Table& table, std::size_t column, const Persons& persons);
    void tellInBands(Table& table, const Persons& persons);
    void listSmallCells(const Table& table, const Persons& persons);
    void note(Entry entry);
    int weeksOf(const std::string& participant);

    Anonymity how_;
    Random random_;
    std::map<std::string, int> weeks_;  // by participant
    std::set<std::string> used_;        // items in bands
    std::vector<Entry> entries_;
};

}  // namespace passung::exporter
