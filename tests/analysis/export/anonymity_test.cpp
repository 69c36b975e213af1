#include "analysis/export/anonymity.h"

#include <gtest/gtest.h>

#include <ctime>
#include <fstream>
#include <map>
#include <set>

#include "analysis/export/export.h"
#include "study/store/people/participant_records.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/study/store/fake_questionnaire.h"

namespace passung::exporter {
namespace {

using fake::require;

/// Days since 1970 of the date that an ISO 8601 text begins with, by the C library.
long dayOf(const std::string& time) {
    std::tm date{};
    EXPECT_NE(strptime(time.c_str(), "%Y-%m-%d", &date), nullptr) << time;
    return timegm(&date) / 86400;
}

/// When two people, of whom one is simulated, came; with what somebody typed.
Table visits() {
    return {
        "visits.csv",
        "",
        {describe("participant_id", "", "text", {}), describe("kind", "", "text", {}),
         describe("t_utc", "", "time", {}), describe("payload_json", "", "text", {.typed = true}),
         describe("not_counted_because", "", "text", {.typed = true}), describe("text", "", "text", {.typed = true})},
        {{"P001", "real", "2024-03-01T10:00:00.250Z", R"({"n":3,"share":0.5})", "not valid: Anna left", "Anna"},
         {"P001", "real", "2024-03-02T23:59:59.999Z", R"({"reason":"Anna left"})", "catch trial", "NA"},
         {"P002", "real", "2024-01-01T00:00:00.000Z", "NA", "NA", "Bert"},
         {"S001", "simulated", "2000-01-01T00:00:00.000Z", R"({"reason":"none"})", "not valid: jump", "said"}}};
}

void apply(Anonymiser& anonymiser, Table& table) {
    Anonymiser::Work work = anonymiser.begin(table);
    for (TableRow& row : table.rows) work.change(row);
    work.end();
}

TEST(Anonymity, SetsAPersonsTimesBackByTheSameWholeWeeks) {
    // Truth: closed form (days by the C library's calendar): a multiple of seven between 7 and 364 for each person, so
    // that intervals, weekdays and times of day stay; simulated participants have their times.
    std::set<long> shifts;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        Table table = visits();
        Anonymiser anonymiser({{}, 5, seed});
        apply(anonymiser, table);
        const long first = dayOf(visits().rows[0][2]) - dayOf(table.rows[0][2]);
        EXPECT_EQ(dayOf(visits().rows[1][2]) - dayOf(table.rows[1][2]), first);
        EXPECT_EQ(first % 7, 0);
        EXPECT_TRUE(first >= 7 && first <= 364) << first;
        EXPECT_EQ(table.rows[0][2].substr(10), "T10:00:00.250Z");
        EXPECT_EQ(table.rows[3][2], visits().rows[3][2]);
        shifts.insert(first);
    }
    EXPECT_GT(shifts.size(), 40u) << "of 52 weeks 300 draws meet nearly all";
}

TEST(Anonymity, PersonsHaveWeeksOfTheirOwnInAllTables) {
    // Truth: invariant
    int alike = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        Anonymiser anonymiser({{}, 5, seed});
        Table table = visits(), again = visits();
        apply(anonymiser, table);
        apply(anonymiser, again);
        EXPECT_EQ(table.rows, again.rows);
        if (dayOf(visits().rows[0][2]) - dayOf(table.rows[0][2]) ==
            dayOf(visits().rows[2][2]) - dayOf(table.rows[2][2]))
            ++alike;
    }
    EXPECT_LT(alike, 10) << "two of a hundred are expected";
}

TEST(Anonymity, LeavesOutWhatSomebodyTypedAndKeepsWhatTheProgramSays) {
    // Truth: closed form
    Table table = visits();
    Anonymiser anonymiser({{}, 5, 1});
    apply(anonymiser, table);
    EXPECT_EQ(table.rows[0][3], R"({"n":3,"share":0.5})");
    EXPECT_EQ(table.rows[0][4], "not valid");
    EXPECT_EQ(table.rows[0][5], "NA");
    EXPECT_EQ(table.rows[1][3], "NA");
    EXPECT_EQ(table.rows[1][4], "catch trial");
    EXPECT_EQ(table.rows[3], visits().rows[3]);
    const Table account = anonymiser.account();
    std::map<std::string, std::string> cells;
    for (const auto& row : account.rows) cells[row[1]] = row[4];
    EXPECT_EQ(cells, (std::map<std::string, std::string>{
                         {"t_utc", "3"}, {"payload_json", "1"}, {"not_counted_because", "1"}, {"text", "2"}}));
}

TEST(Anonymity, TellsAnswersInBandsAndListsThoseOfFew) {
    // Truth: closed form: ages 34, 38, 41 in tens; hands 1, 1, 2; a mood that was asked twice is no mark of a person.
    Table table{"items.csv", "", {}, {}};
    for (const char* name : {"participant_id", "kind", "questionnaire", "item", "value"})
        table.columns.push_back(describe(name, "", "text", {}));
    const auto answer = [&](const char* who, const char* item, const char* value) {
        table.rows.push_back({who, "real", "about", item, value});
    };
    const char* people[] = {"P001", "P002", "P003"};
    const char* ages[] = {"34", "38", "41"};
    const char* hands[] = {"1", "1", "2"};
    for (int i = 0; i < 3; ++i) {
        answer(people[i], "age", ages[i]);
        answer(people[i], "hand", hands[i]);
        answer(people[i], "mood", "7");
        answer(people[i], "mood", "5");
    }
    Anonymiser anonymiser({{{"about.age", 10}, {"about.height", 5}}, 2, 1});
    apply(anonymiser, table);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(table.rows[4 * i][4], i < 2 ? "30" : "40");
    EXPECT_EQ(anonymiser.unusedBands(), std::vector<std::string>{"about.height"});
    std::set<std::string> few;
    for (const auto& row : anonymiser.account().rows)
        if (row[2].find("fewer than 2") != std::string::npos) few.insert(row[3]);
    EXPECT_EQ(few, (std::set<std::string>{"about.age=40", "about.hand=2"}));
}

TEST(Anonymity, BandsAreReadAsWritten) {
    // Truth: invariant
    EXPECT_EQ(readBand("demographics.age=10")->item, "demographics.age");
    EXPECT_EQ(readBand("demographics.age=2.5")->width, 2.5);
    for (const char* text :
         {"demographics.age", "age=10", "a.b=", "a.b=0", "a.b=-1", "a.b=x", "a.b=10x", "a.b=inf", ""})
        EXPECT_FALSE(readBand(text)) << text;
}

/// All bytes of the files below a folder.
std::string bytesBelow(const std::string& folder) {
    std::string all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        std::ifstream file(entry.path(), std::ios::binary);
        all.append(std::istreambuf_iterator<char>(file), {});
    }
    return all;
}

TEST(Anonymity, NoFileOfTheExportHoldsAWordThatAPersonWrote) {
    // Truth: invariant: the bytes of the folder are searched; without --anonymous they have what is looked for.
    const fake::TempFolder folder;
    const plan::StudyPlan plan = fake::makeAskingPlan();
    {
        auto store = fake::openStore(folder / "s.db");
        for (const char* code : {"P001", "P002"}) {
            auto writer = fake::beginAskingSession(*store, plan, code, 4, plan::ParticipantKind::Real);
            require(fake::storeForm(*writer, plan, {1, {}, {}, {}}, {34, 1, 2, 1, 0, 3, std::nullopt}, 2'000'000'000,
                                    "Annas words"));
            require(writer->finishSession(true, 3'000'000'000));
        }
    }
    const auto reader = require(store::StoreReader::open(folder / "s.db"));
    require(exportAll(reader, folder / "open", {}));
    EXPECT_NE(bytesBelow(folder / "open").find("Annas words"), std::string::npos);
    EXPECT_NE(bytesBelow(folder / "open").find("2000-01-01T00:00:00.000Z"), std::string::npos);
    ExportOptions options;
    options.anonymity = Anonymity{{{"demographics.age", 10}}, 5, 1};
    require(exportAll(reader, folder / "hidden", options));
    const std::string hidden = bytesBelow(folder / "hidden");
    EXPECT_EQ(hidden.find("Annas words"), std::string::npos);
    EXPECT_EQ(hidden.find("2000-01-01T00:00:00.000Z"), std::string::npos);
    EXPECT_NE(hidden.find("P001"), std::string::npos);
    options.anonymity->bands = {{"demographics.shoes", 10}};
    const auto refused = exportAll(reader, folder / "refused", options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.errors().front().value, "demographics.shoes");
    EXPECT_FALSE(std::filesystem::exists(folder / "refused"));
}

}  // namespace
}  // namespace passung::exporter
