#include <gtest/gtest.h>

#include "study/store/read/store_reader.h"
#include "tests/study/store/fake_study.h"
#include "tests/support/count_checks.h"

namespace passung::store {
namespace {

using fake::require;

TEST(ReaderChecks, AFileIsWalkedThroughOnceAndOneKnownToBeWholeNotAtAll) {
    // Truth: independent program (SQLite tells each statement that it runs).
    const fake::TempFolder folder;
    {
        const auto store = fake::openStore(folder / "s.db");
        const auto writer = fake::beginSession(*store, "S001", 1);
        require(fake::writeAttempt(*writer, 0, 50));
        require(writer->finishSession(true, 10));
    }
    const auto checksOf = [&](Damaged damaged) {
        const test::CountChecks checks;
        const StoreReader reader = require(StoreReader::open(folder / "s.db", damaged));
        EXPECT_EQ(require(reader.attempts()).size(), 1u);
        return checks.count();
    };
    EXPECT_EQ(checksOf(Damaged::Refused), 1);
    EXPECT_EQ(checksOf(Damaged::HandedOut), 1);
    EXPECT_EQ(checksOf(Damaged::LeftOut), 1);
    EXPECT_EQ(checksOf(Damaged::LeftOutWithSamples), 1);
    EXPECT_EQ(checksOf(Damaged::KnownWhole), 0);
}

}  // namespace
}  // namespace passung::store
