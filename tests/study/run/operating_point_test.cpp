#include "study/run/operating_point.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/scene/contact_geometry.h"
#include "study/run/files/protocol_files.h"
#include "study/run/files/replace_file.h"
#include "study/run/run_study.h"
#include "tests/support/temp_folder.h"
#include "tests/ui/cli/small_study.h"

namespace passung::run {
namespace {

using Outcome = OperatingPoint::Outcome;
using scene::ContactMethod;
using scene::Geometry;

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The small study without a factor of its method, in a file.
class UseSetting : public ::testing::Test {
protected:
    UseSetting() { write(text_); }

    void write(const std::string& text) const { std::ofstream(path_) << text; }

    plan::StudyPlan read() const {
        auto plan = readProtocol(path_);
        if (!plan) throw std::runtime_error(toString(plan.errors().front()));
        return *std::move(plan);
    }
    static TickFront frontOf(const plan::StudyPlan& plan) {
        TickFront front;
        front.own = plan.conditions[0].scene.contact;
        return front;
    }
    OperatingPoint use(const truth::TickSetting& setting) const { return use(read(), setting); }
    OperatingPoint use(const plan::StudyPlan& plan, const truth::TickSetting& setting) const {
        return useSetting(plan, 0, frontOf(plan), setting, database_);
    }

    test::TempFolder folder_;
    std::string text_ = test::oneMethodStudy(), path_ = folder_ / "study.toml", database_ = folder_ / "study.db";
};

TEST_F(UseSetting, TheFileReadsAsEverySettingThatCanBeMeasured) {
    // Truth: invariant: what was chosen is what the reader gives, number by number; the rest of the plan is as it was.
    // The default tolerance is no quotient of a decimal and a million: it is read as its neighbour.
    const plan::StudyPlan before = read();
    const TickFront front = frontOf(before);
    truth::TickSpace space;
    space.spacings = {0.5 * front.own.spacing, front.own.spacing, 712.3 / 1e6};
    space.tolerances = {2.0 * front.own.tolerance, front.own.tolerance, 17.3 / 1e6};
    space.modes = {field::FieldMode::Cubic, field::FieldMode::Trilinear};
    space.budgets = {0, 300};
    space.ways = {1, 2};
    std::size_t written = 0;
    const auto settings = truth::tickSettings(before.conditions[0].scene, space).settings;
    ASSERT_GT(settings.size(), 200u);
    for (std::size_t i = 0; i < settings.size(); i += 7) {
        write(text_);
        const plan::StudyPlan plan = read();
        const OperatingPoint point = use(plan, settings[i]);
        ASSERT_EQ(point.outcome, Outcome::Written) << scene::methodName(settings[i].method) << toString(point.problem);
        const plan::StudyPlan after = read();
        for (const plan::Condition& condition : after.conditions) {
            const scene::ContactSpec& contact = condition.scene.contact;
            EXPECT_EQ(contact.method, settings[i].method);
            EXPECT_EQ(contact.geometry, settings[i].geometry);
            if (settings[i].geometry != Geometry::Field) continue;
            const bool own = settings[i].field.tolerance == front.own.tolerance;
            EXPECT_EQ(contact.cell, own ? front.own.cell : 0.0);
            if (!own) {
                EXPECT_DOUBLE_EQ(contact.tolerance, settings[i].field.tolerance);
            }
            EXPECT_EQ(contact.spacing, settings[i].field.spacing);
            EXPECT_EQ(contact.mode, settings[i].field.mode);
            EXPECT_EQ(contact.budget_nodes, settings[i].field.budget_nodes);
            EXPECT_EQ(contact.two_way, settings[i].two_way);
        }
        EXPECT_EQ(after.name, before.name);
        EXPECT_EQ(after.blocks.size(), before.blocks.size());
        EXPECT_EQ(use(settings[i]).outcome, Outcome::SaidAlready);
        ++written;
    }
    EXPECT_GT(written, 30u);
}

TEST_F(UseSetting, ALengthWithoutADecimalOfItsOwnIsReadAsItsNeighbour) {
    // Truth: closed form: one rounding to the file's unit and one back.
    const double third = 1.0 / 70000.0;
    truth::TickSetting setting{.method = ContactMethod::Penalty, .geometry = Geometry::Field, .field = {}};
    setting.field.tolerance = third;
    const OperatingPoint point = use(setting);
    ASSERT_EQ(point.outcome, Outcome::Written) << toString(point.problem);
    EXPECT_NEAR(read().conditions[0].scene.contact.tolerance, third, 3e-16 * third);
}

TEST_F(UseSetting, OneSettingAfterAnotherEndsWhereTheFirstBegan) {
    // Truth: invariant: a cell that the study had comes back with the setting that was measured with it.
    const TickFront front = frontOf(read());
    const truth::TickSetting own{.method = ContactMethod::Penalty,
                                 .geometry = Geometry::Field,
                                 .field = {front.own.mode, front.own.tolerance, front.own.spacing, 0},
                                 .two_way = front.own.two_way};
    truth::TickSetting other = own;
    other.field.tolerance = 60e-6;
    for (const auto& setting : {own, other, own}) {
        const auto point = useSetting(read(), 0, front, setting, database_);
        ASSERT_EQ(point.outcome, Outcome::Written) << toString(point.problem);
        EXPECT_TRUE(isRenderedBy(read().conditions[0].scene, front, setting));
    }
    EXPECT_EQ(read().conditions[0].scene.contact.cell, 1e-3);
}

TEST_F(UseSetting, WritesNothingWhereTheFileOrTheStudyIsNotWhatWasMeasured) {
    // Truth: invariant: each reason leaves every byte as it was, and no file beside it.
    const truth::TickSetting setting{.method = ContactMethod::GodObject, .geometry = Geometry::Surface};
    const plan::StudyPlan measured = read();
    write(text_ + "# a word\n");
    EXPECT_EQ(use(measured, setting).outcome, Outcome::FileChanged);
    EXPECT_EQ(contents(path_), text_ + "# a word\n");
    std::filesystem::remove(path_);
    EXPECT_EQ(use(measured, setting).outcome, Outcome::FileChanged);
    write(text_);

    std::filesystem::permissions(path_, std::filesystem::perms::owner_read | std::filesystem::perms::group_read);
    RunOptions options;
    options.database = database_;
    options.simulated = 1;
    options.backup = false;
    ASSERT_TRUE(runStudy(read(), options, {}));
    EXPECT_EQ(use(setting).outcome, Outcome::Begun);
    EXPECT_EQ(contents(path_), text_);
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "."))
        EXPECT_EQ(entry.path().filename().string().find("study.toml."), std::string::npos) << entry.path();
}

TEST_F(UseSetting, ALevelOfAFactorKeepsItsKeyAndTheOthersAreWritten) {
    // Truth: closed form: the place of the key in the text. The penalty has no closed form, so that a study with both
    // methods keeps geometry = "auto", which picks it for the god object.
    write(test::fairStudy());
    const plan::StudyPlan plan = read();
    const auto on = [&](std::size_t condition, const truth::TickSetting& setting) {
        TickFront front;
        front.own = plan.conditions[condition].scene.contact;
        return useSetting(plan, condition, front, setting, database_);
    };
    const auto refused = on(0, {.method = ContactMethod::GodObject, .geometry = Geometry::ClosedForm});
    EXPECT_EQ(refused.outcome, Outcome::SetElsewhere);
    const std::string text = contents(path_);
    const auto line =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find("\"penalty\"")), '\n');
    EXPECT_EQ(refused.problem.line, line + 1);
    EXPECT_EQ(refused.problem.key, "contact.method");
    EXPECT_EQ(contents(path_), test::fairStudy());
    EXPECT_EQ(on(1, {.method = ContactMethod::GodObjectHeuristic, .geometry = Geometry::ClosedForm}).outcome,
              Outcome::SaidAlready);
    EXPECT_EQ(on(0, {.method = ContactMethod::Penalty,
                     .geometry = Geometry::Field,
                     .field = {field::FieldMode::Cubic, plan.conditions[0].scene.contact.tolerance, 2e-3, 0}})
                  .outcome,
              Outcome::Written);
    EXPECT_EQ(read().conditions[0].scene.contact.spacing, 2e-3);
    EXPECT_EQ(read().conditions[0].scene.contact.mode, field::FieldMode::Cubic);
}

TEST_F(UseSetting, AccuracyThatTheProgramPicksGivesWayToAChosenOne) {
    // Truth: invariant: the reader refuses the keys beside accuracy = "auto".
    std::string text = text_;
    text.replace(text.find("cell_mm = 1.0\nspacing_mm = 3.0"), 30,
                 "accuracy = \"auto\"\naccuracy_budget_us = 90 # fast");
    write(text);
    const auto point = use({.method = ContactMethod::GodObject, .geometry = Geometry::Surface});
    ASSERT_EQ(point.outcome, Outcome::Written) << toString(point.problem);
    EXPECT_EQ(read().conditions[0].accuracy_budget, 0.0);
    EXPECT_NE(contents(path_).find("# fast"), std::string::npos);
}

TEST(ReplaceFile, FollowsLinksAndKeepsPermissions) {
    // Truth: invariant
    namespace fs = std::filesystem;
    const test::TempFolder folder;
    std::ofstream(folder / "real") << "old";
    fs::permissions(folder / "real", fs::perms::owner_read | fs::perms::owner_write | fs::perms::others_read);
    fs::create_symlink("real", folder / "link");
    Error problem;
    EXPECT_EQ(replaceFile(folder / "link", "older", "new", problem), Replaced::Changed);
    EXPECT_EQ(contents(folder / "real"), "old");
    EXPECT_EQ(replaceFile(folder / "link", "old", "new", problem), Replaced::Done);
    EXPECT_EQ(contents(folder / "real"), "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(fs::status(folder / "real").permissions(),
              fs::perms::owner_read | fs::perms::owner_write | fs::perms::others_read);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "."), fs::directory_iterator()), 2);
    EXPECT_EQ(replaceFile(folder / "none", "", "new", problem), Replaced::Changed);
}

}  // namespace
}  // namespace passung::run
