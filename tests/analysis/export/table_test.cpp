#include "analysis/export/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "analysis/export/columns.h"
#include "core/base/random.h"
#include "tests/analysis/export/csv_reader.h"

namespace passung::exporter {
namespace {

TEST(Table, HardTextsComeBackFromAnIndependentReader) {
    // Truth: independent program (the test's own reader of RFC 4180)
    const std::vector<std::string> texts = {"",       "plain", "a,b",      "say \"hi\"", "\"",          "two\nlines",
                                            "cr\r\n", "it's",  " spaces ", "Größe µm",   "a;b\tc",      ",",
                                            "\"\"",   "=1+1",  "1.5",      "\n",         "end quote\"", "NA"};
    Table table{"t.csv", "", {{"first, \"column\"", "", "", "", "", 1, {}}, {"second", "", "", "", "", 1, {}}}, {}};
    for (std::size_t i = 0; i < texts.size(); ++i) table.rows.push_back({texts[i], texts[texts.size() - 1 - i]});
    const fake::CsvFile back = fake::readCsv(toCsv(table));
    EXPECT_EQ(back.header[0], "first, \"column\"");
    EXPECT_EQ(back.rows, table.rows);
}

TEST(Table, ACellStandsUnderTheColumnThatSaysWhereItComesFrom) {
    // Truth: closed form
    struct Part {
        std::int64_t number;
        std::optional<double> width;
    };
    struct Row {
        std::string name;
        Part part;
    };
    const ColumnsOf<Part> of_part = {{"number", "", "integer", &Part::number},
                                     {"width_m", "", "number", &Part::width, {.unit = "m"}}};
    ColumnsOf<Row> columns = {{"name", "Its name", "text", &Row::name}};
    append(columns, of_part, [](const Row& row) -> const Part& { return row.part; });
    append(columns, {{"long", "", "0/1", [](const Row& row) { return row.name.size() > 3; }, {.levels = {"0", "1"}}}});
    const Table table = makeTable("t.csv", "", columns, std::vector<Row>{{"peg", {1, 0.5}}, {"block", {2, {}}}});
    EXPECT_EQ(toCsv(table), "name,number,width_m,long\npeg,1,0.5,0\nblock,2,NA,1\n");
    EXPECT_EQ(table.columns[0].label, "Its name");
    EXPECT_EQ(table.columns[2].unit, "m");
    EXPECT_EQ(table.columns[3].levels, (std::vector<std::string>{"0", "1"}));
}

TEST(Table, NumbersReadBackToTheSameBitsAndAreShort) {
    // Truth: independent program (the C library's strtod, strtof)
    Random random(3);
    for (int i = 0; i < 20'000; ++i) {
        const double value = random.normal() * std::pow(10.0, random.uniform(-300, 300));
        EXPECT_EQ(std::strtod(cell(value).c_str(), nullptr), value);
        const auto single = static_cast<float>(random.normal());
        EXPECT_EQ(std::strtod(cell(single).c_str(), nullptr), static_cast<double>(single)) << "a reader of doubles";
    }
    EXPECT_EQ(cell(0.1), "0.1");
    EXPECT_EQ(cell(0.1f), "0.10000000149011612");
    EXPECT_EQ(cell(1.0), "1");
    EXPECT_EQ(cell(-0.0), "-0");
    EXPECT_EQ(cell(std::int64_t{-5}), "-5");
    EXPECT_EQ(secondsCell(1'500'000'000), "1.5");
}

TEST(Table, WhatIsMissingOrNotFiniteIsNa) {
    // Truth: closed form (the format's rule)
    EXPECT_EQ(cell(std::nan("")), "NA");
    EXPECT_EQ(cell(std::numeric_limits<double>::infinity()), "NA");
    EXPECT_EQ(cell(std::optional<double>()), "NA");
    EXPECT_EQ(cell(std::optional<std::string>()), "NA");
    EXPECT_EQ(secondsCell(std::nullopt), "NA");
}

}  // namespace
}  // namespace passung::exporter
