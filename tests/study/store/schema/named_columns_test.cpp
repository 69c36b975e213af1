#include "study/store/schema/named_columns.h"

#include <gtest/gtest.h>

namespace passung::store {
namespace {

struct Pair {
    std::string name;
    std::optional<double> left;
    std::int64_t right = 0;
};

const Selection<Pair> kPairs = {{"name", &Pair::name}, {"a", &Pair::left}, {"b", &Pair::right}};

/// A table whose columns stand in another order than in Pair.
class NamedColumns : public testing::Test {
protected:
    void SetUp() override {
        database_.execute("CREATE TABLE pair(b INTEGER NOT NULL, a REAL, name TEXT UNIQUE) STRICT");
    }
    Database database_{":memory:", OpenMode::ReadWrite};
};

TEST_F(NamedColumns, AValueGoesIntoTheColumnOfItsNameAndComesBackFromThere) {
    // Truth: closed form
    insertRow(database_, "pair", Named{"name", "one"}, Named{"a", 0.5}, Named{"b", 7});
    insertRow(database_, "pair", Named{"b", 8}, Named{"name", std::string("two")});
    const auto rows = kPairs.all(database_, "FROM pair ORDER BY b");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(std::tie(rows[0].name, rows[0].left, rows[0].right), std::tuple("one", std::optional(0.5), 7));
    EXPECT_EQ(std::tie(rows[1].name, rows[1].left, rows[1].right), std::tuple("two", std::optional<double>(), 8));
}

TEST_F(NamedColumns, AKeyThatIsThereIsLeftAsItIs) {
    // Truth: closed form
    insertRow(database_, "pair", Named{"name", "one"}, Named{"b", 7});
    insertRowIfNew(database_, "pair", Named{"name", "one"}, Named{"b", 8});
    EXPECT_EQ(database_.integer("SELECT b FROM pair"), 7);
    EXPECT_THROW(insertRow(database_, "pair", Named{"name", "one"}, Named{"b", 8}), SqliteError);
}

TEST_F(NamedColumns, ASelectionIsReadFromWhereItBegins) {
    // Truth: closed form
    insertRow(database_, "pair", Named{"name", "one"}, Named{"a", 0.5}, Named{"b", 7});
    Statement row = database_.prepare("SELECT 1, 2, " + kPairs.text() + " FROM pair");
    ASSERT_TRUE(row.step());
    EXPECT_EQ(kPairs.read(row, 2).name, "one");
    EXPECT_EQ(kPairs.read(row, 2).right, 7);
}

}  // namespace
}  // namespace passung::store
