#include "study/protocol/include.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "devices/simulated/presets.h"
#include "study/design/trial_order.h"
#include "study/protocol/protocol_reader.h"

namespace passung::protocol {
namespace {

namespace fs = std::filesystem;

class IncludeTest : public testing::Test {
protected:
    IncludeTest() : folder_(fs::temp_directory_path() / ("passung_include_" + std::to_string(getpid()))) {
        fs::create_directories(folder_);
    }
    ~IncludeTest() override { fs::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return (folder_ / name).string();
    }

    fs::path folder_;
};

std::vector<DeviceDescription> devices() { return {simulated::describe(*simulated::findPreset("sigma7"))}; }

constexpr const char* kParts = R"([[scene.part]]
name = "plate"
shape = { kind = "bore_plate", width = 60, depth = 60, height = 30, bore_diameter = 21, bore_depth = 25 }

[[scene.part]]
name = "peg"
held = true
shape = { kind = "peg", diameter = 20, length = 50 }
pose = { position = [0, 0, 30] }
)";

constexpr const char* kStudy = R"(passung = 1
[study]
name = "small"
version = "1"
seed = 1
participants = 2
include = "parts.toml"   # the parts
[scene.device]
preset = "sigma7"
[[factor]]
name = "method"
key = "contact.method"
levels = ["penalty", "god_object"]
[task]
type = "peg_in_hole"
target = "plate"
[[block]]
name = "short"
set = { "task.timeout_s" = 5 }
[[block]]
name = "long"
)";

TEST_F(IncludeTest, TheStoredTextIsAllOfIt) {
    // Truth: invariant: what is stored reads as the same study where no other file is.
    write("parts.toml", kParts);
    const auto plan = readProtocol(write("study.toml", kStudy), devices(), {});
    ASSERT_TRUE(plan) << toString(plan.errors()[0]);
    EXPECT_NE(plan->source_text.find("# parts.toml begins\n[[scene.part]]\nname = \"plate\"\n"), std::string::npos);
    const auto alone = readProtocolText(plan->source_text, "elsewhere/stored.toml", devices(), {});
    ASSERT_TRUE(alone) << toString(alone.errors()[0]);
    EXPECT_EQ(alone->expanded_json, plan->expanded_json);
    EXPECT_EQ(alone->source_text, plan->source_text);
}

TEST_F(IncludeTest, TextWithoutIncludesIsKeptByteForByte) {
    // Truth: invariant, for a file whose last line does not end too.
    const std::string text = "a = 1\r\n# include = \"x\"\nincluded = \"y\"";
    const auto included = includeFiles(text, "study.toml");
    ASSERT_TRUE(included);
    EXPECT_EQ(included->text, text);
}

TEST_F(IncludeTest, MistakesArePlacedInTheFileThatHasThem) {
    // Truth: counted by hand: in line 3 of parts.toml the table without its width stands from column 9, the misspelt
    // word from column 32; the preset stands in line 9 of the study.
    std::string parts = kParts;
    parts.replace(parts.find("width"), 5, "witdh");
    const std::string other = write("parts.toml", parts);
    std::string study = kStudy;
    study.replace(study.find("sigma7"), 6, "sigma9");
    const std::string path = write("study.toml", study);
    const auto plan = readProtocol(path, devices(), {});
    ASSERT_FALSE(plan);
    ASSERT_GE(plan.errors().size(), 2u);
    EXPECT_EQ(plan.errors()[0].file, other);
    EXPECT_EQ(plan.errors()[0].line, 3);
    EXPECT_EQ(plan.errors()[0].column, 9);
    EXPECT_EQ(plan.errors()[1].column, 32);
    EXPECT_EQ(plan.errors().back().file, path);
    EXPECT_EQ(plan.errors().back().line, 9);
    write("parts.toml", "[[scene.part]]\nname =\n");
    const auto broken = readProtocol(path, devices(), {});
    ASSERT_FALSE(broken);
    EXPECT_EQ(broken.errors()[0].file, other);
    EXPECT_EQ(broken.errors()[0].line, 2);
}

TEST_F(IncludeTest, ABlocksOwnKeysHoldInItsConditionsOnly) {
    // Truth: closed form: two methods, two blocks; the first block has its own two conditions behind the shared ones.
    write("parts.toml", kParts);
    const auto plan = readProtocol(write("study.toml", kStudy), devices(), {});
    ASSERT_TRUE(plan) << toString(plan.errors()[0]);
    ASSERT_EQ(plan->conditions.size(), 4u);
    EXPECT_EQ(plan->conditions[2].name, "penalty@short");
    EXPECT_EQ(plan->conditions[2].levels_json, plan->conditions[0].levels_json);
    const auto trials = *design::planSession(plan::designOf(*plan), {"small", 1, "P001"});
    ASSERT_EQ(trials.size(), 4u);
    for (const auto& trial : trials) {
        const auto& condition = plan->conditions[trial.condition];
        EXPECT_EQ(condition.task.timeout, trial.block == "short" ? 5.0 : 30.0);
        EXPECT_EQ(condition.name.ends_with("@short"), trial.block == "short");
    }
}

}  // namespace
}  // namespace passung::protocol
