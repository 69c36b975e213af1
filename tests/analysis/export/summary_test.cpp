#include "analysis/export/summary.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/study/store/fake_study.h"

namespace passung::exporter {
namespace {

using fake::require;

std::string summaryOf(const std::string& path) {
    return require(summaryTable(require(store::StoreReader::open(path))));
}

TEST(Summary, CountsOnlyValidMainTrialsAndAveragesThem) {
    // Truth: closed form (conditions 0, 1, 2, 3 in turn; completion times 1.0, 1.1 … s; peak force 1/3 N)
    const fake::TempFolder folder;
    const std::string path = folder / "s.db";
    {
        auto store = fake::openStore(path);
        auto writer = fake::beginSession(*store, "S001", 8);
        const auto endOf = [](std::int64_t trial) {
            session::AttemptEnd end = fake::attemptEnd(trial, 5);
            for (auto& measure : end.measures)
                if (measure.name == "time_s") measure.value = 1.0 + 0.1 * static_cast<double>(trial);
            return end;
        };
        for (std::int64_t trial = 0; trial < 6; ++trial)
            require(writer->finishAttempt(require(writer->startAttempt(fake::attemptStart(trial))), endOf(trial)));
        const auto spoilt = require(writer->startAttempt(fake::attemptStart(6)));
        session::AttemptEnd end = endOf(6);
        end.valid = false;
        require(writer->finishAttempt(spoilt, end));
        const auto late = require(writer->startAttempt(fake::attemptStart(7)));
        end = fake::attemptEnd(7, 5);
        end.outcome = measures::Outcome::Timeout;
        end.measures.clear();
        require(writer->finishAttempt(late, end));
    }
    std::istringstream lines(summaryOf(path));
    std::string title, header, first, second, third, fourth;
    for (std::string* line : {&title, &header, &first, &second, &third, &fourth}) std::getline(lines, *line);
    EXPECT_NE(title.find("simulated participants: 1"), std::string::npos) << title;
    const auto cells = [](const std::string& line) {
        std::istringstream stream(line);
        std::vector<std::string> found;
        for (std::string cell; stream >> cell;) found.push_back(cell);
        return found;
    };
    // condition, trials, success, time, hand depth, proxy depth, mean force, peak force
    EXPECT_EQ(cells(first), (std::vector<std::string>{"penalty/0.1", "2", "100.0", "1.20", "-", "-", "-", "0.33"}));
    EXPECT_EQ(cells(second), (std::vector<std::string>{"penalty/0,5", "2", "100.0", "1.30", "-", "-", "-", "0.33"}));
    EXPECT_EQ(cells(third), (std::vector<std::string>{"god/0.1", "1", "100.0", "1.20", "-", "-", "-", "0.33"}));
    EXPECT_EQ(cells(fourth), (std::vector<std::string>{"god/0,5", "2", "50.0", "1.30", "-", "-", "-", "0.33"}));
    EXPECT_EQ(header.size(), first.size());
    EXPECT_EQ(header.size(), fourth.size());
}

TEST(Summary, KeepsVersionsOfAProtocolApart) {
    // Truth: closed form: one participant with one attempt (1.0 s) under each of two versions.
    const fake::TempFolder folder;
    plan::StudyPlan later = fake::makePlan();
    later.version = "1.1";
    later.source_text += "# changed\n";
    {
        auto store = fake::openStore(folder / "s.db");
        require(fake::writeAttempt(*fake::beginSession(*store, "S001", 1), 0, 5));
        require(fake::writeAttempt(*fake::beginSession(*store, "S002", 1, false, later), 0, 5));
    }
    const std::string text = summaryOf(folder / "s.db");
    const auto first = text.find("fake 1.0, simulated participants: 1."),
               second = text.find("fake 1.1, simulated participants: 1.");
    ASSERT_NE(first, std::string::npos) << text;
    ASSERT_NE(second, std::string::npos) << text;
    EXPECT_LT(text.find("penalty/0.1       1"), second) << text;
    EXPECT_EQ(text.find("penalty/0.1       2"), std::string::npos) << text;
}

TEST(Summary, AnEmptyStudyHasNoTable) {
    // Truth: invariant
    const fake::TempFolder folder;
    fake::openStore(folder / "s.db");
    EXPECT_EQ(summaryOf(folder / "s.db"), "no trials yet\n");
}

}  // namespace
}  // namespace passung::exporter
