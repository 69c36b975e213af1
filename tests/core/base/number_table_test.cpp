#include "core/base/number_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace passung {
namespace {

std::string file(const std::string& text) {
    const auto path = std::filesystem::temp_directory_path() / ("passung_numbers_" + std::to_string(getpid()) + ".csv");
    std::ofstream(path) << text;
    return path.string();
}

TEST(NumberTable, ReadsNumbersNanAndForeignLineEnds) {
    // Truth: closed form (the text itself).
    const auto table = readNumbers(file("a,b\r\n1,-2.5e-3\r\nnan, +4\r\ninf,0\r\n\n"), {"a", "b"});
    ASSERT_TRUE(table);
    ASSERT_EQ(table->rows.size(), 3u);
    EXPECT_EQ(table->rows[0][1], -2.5e-3);
    EXPECT_TRUE(std::isnan(table->rows[1][0]));
    EXPECT_EQ(table->rows[1][1], 4.0);
    EXPECT_TRUE(std::isinf(table->rows[2][0]));
}

TEST(NumberTable, PassesOverAByteOrderMarkAndNamesSemicolons) {
    // Truth: closed form (the text itself).
    const auto table = readNumbers(file("\xEF\xBB\xBF"
                                        "a,b\n1,2\n"),
                                   {"a", "b"});
    ASSERT_TRUE(table) << toString(table.errors().front());
    EXPECT_EQ(table->headerLine(), "a,b");
    for (const char* text : {"a;b\n1;2\n", "a,b\n1;2\n"}) {
        const auto bad = readNumbers(file(text), {"a", "b"});
        ASSERT_FALSE(bad);
        EXPECT_NE(toString(bad.errors().front()).find("commas, not by semicolons"), std::string::npos);
    }
}

TEST(NumberTable, KeepsFurtherColumnsAsTheyAreWritten) {
    // Truth: closed form (the text itself): a comma in quotes parts nothing, a quote is doubled.
    const auto table = readNumbers(file("a,b,note,\"x, y\"\n1,2,\"one, \"\"or\"\" two\",0.10\n3,4,,7\n"), {"a", "b"});
    ASSERT_TRUE(table);
    EXPECT_EQ(table->headerLine(), "a,b,note,\"x, y\"");
    ASSERT_EQ(table->texts.size(), 2u);
    EXPECT_EQ(table->rowLine(0), "1,2,\"one, \"\"or\"\" two\",0.10");
    EXPECT_EQ(table->rowLine(1), "3,4,,7");
    EXPECT_EQ(table->rows[0], (std::vector<double>{1, 2}));
}

TEST(NumberTable, KnowsTheLineOfEveryRow) {
    // Truth: closed form (the text itself): empty lines count as lines and are no rows.
    const auto table = readNumbers(file("a\n1\n\n  \r\n2\n\n3\n\n"), {"a"});
    ASSERT_TRUE(table);
    EXPECT_EQ(table->lines, (std::vector<int>{2, 5, 7}));
}

TEST(NumberTable, NamesThePlaceOfEveryBadCell) {
    // Truth: invariant (file:line:column: key: value: requirement).
    const std::string path = file("a,b\n1,2\n3,x4\n5\n6,\n");
    const auto table = readNumbers(path, {"a", "b"});
    ASSERT_FALSE(table);
    ASSERT_EQ(table.errors().size(), 3u);
    EXPECT_EQ(toString(table.errors()[0]), path + ":3:3: error: b: x4: must be a number");
    EXPECT_EQ(toString(table.errors()[1]), path + ":4:1: error: 1: a row needs 2 values");
    EXPECT_EQ(table.errors()[2].line, 5);
}

TEST(NumberTable, RefusesWrongHeadersAndMissingFiles) {
    // Truth: invariant.
    EXPECT_FALSE(readNumbers(file("b,a\n1,2\n"), {"a", "b"}));
    EXPECT_FALSE(readNumbers(file("a\n1\n"), {"a", "b"}));
    EXPECT_FALSE(readNumbers(file("a,b\n"), {"a", "b"}));
    EXPECT_FALSE(readNumbers(file(""), {"a"}));
    EXPECT_FALSE(readNumbers("/no/such/file.csv", {"a"}));
}

}  // namespace
}  // namespace passung
