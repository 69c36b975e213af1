#include "study/protocol/key_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "devices/simulated/presets.h"
#include "study/measures/measures.h"

namespace passung::protocol {
namespace {

std::string completeTable() {
    std::vector<DeviceDescription> devices;
    for (const auto* list : {&simulated::presets(), &simulated::standIns()})
        for (const auto& preset : *list) devices.push_back(simulated::describe(preset));
    std::vector<KnownWord> known;
    for (const auto& measure : measures::definitions()) known.push_back({measure.name, measure.label});
    return keyTable(devices, known);
}

constexpr const char* kHowToWrite = "\nPASSUNG_WRITE_KEYS=1 ./dev room study/protocol/key_table writes the page anew";

TEST(KeyTable, IsWhatTheShippedDocumentSays) {
    // Truth: regression (protocols/KEYS.md, line by line).
    const std::string path = PASSUNG_SOURCE_DIR "/protocols/KEYS.md";
    const std::string text = completeTable();
    if (std::getenv("PASSUNG_WRITE_KEYS") != nullptr) std::ofstream(path, std::ios::binary) << text;
    std::ifstream stream(path, std::ios::binary);
    std::istringstream table(text);
    std::string shipped, line;
    while (std::getline(table, line)) {
        ASSERT_TRUE(std::getline(stream, shipped)) << "KEYS.md ends before: " << line << kHowToWrite;
        ASSERT_EQ(shipped, line) << kHowToWrite;
    }
    EXPECT_FALSE(std::getline(stream, shipped)) << "KEYS.md goes on: " << shipped << kHowToWrite;
}

TEST(KeyTable, DocumentsEveryKeyOnce) {
    // Truth: invariant: every row appears under the heading of its table.
    std::set<std::string> seen;
    std::size_t rows = 0;
    for (const Key& key : keys()) {
        const bool added = seen.insert(std::string(key.table) + "." + std::string(key.name)).second;
        EXPECT_TRUE(added || key.table == "shape") << key.table << "." << key.name;
        EXPECT_FALSE(key.doc.empty()) << key.name;
        EXPECT_TRUE(key.doc.ends_with('.')) << key.name;
    }
    const auto text = keyTable({}, {});
    for (std::size_t at = text.find("\n| `"); at != std::string::npos; at = text.find("\n| `", at + 1)) ++rows;
    EXPECT_EQ(rows, keys().size());
}

TEST(KeyTable, NamesEveryPresetAndEveryMeasure) {
    // Truth: invariant: whoever writes a file finds in the document what it may name.
    const auto text = completeTable();
    for (const auto& preset : simulated::presets())
        EXPECT_NE(text.find("\n| " + simulated::describe(preset).name + " | "), std::string::npos);
    for (const auto& measure : measures::definitions())
        EXPECT_NE(text.find("\n| " + measure.name + " | "), std::string::npos) << measure.name;
}

TEST(KeyTable, DefaultsLieInTheirRanges) {
    // Truth: invariant: a default that a user could not write himself would be a fault of the table.
    for (const Key& key : keys()) {
        const auto value = key.fallbackNumber();
        if (!value) continue;
        EXPECT_TRUE(std::isfinite(*value) && *value <= key.range.high) << key.name;
        EXPECT_TRUE(key.range.low_excluded ? *value > key.range.low : *value >= key.range.low) << key.name;
    }
    for (const Key& key : keys()) {
        if (key.type != KeyType::Choice || key.required() || key.fallback.starts_with('(')) continue;
        const auto choices = key.choiceList();
        EXPECT_EQ(std::count(choices.begin(), choices.end(), key.fallback), 1) << key.name;
    }
}

TEST(KeyTable, ConvertsByTheUnitInTheName) {
    // Truth: closed form: SI prefixes; 180 degrees are pi.
    EXPECT_EQ(unitsPerSi("tolerance_um"), 1e6);
    EXPECT_EQ(unitsPerSi("spacing_mm"), 1e3);
    EXPECT_EQ(unitsPerSi("hold_ms"), 1e3);
    EXPECT_EQ(unitsPerSi("max_speed_mm_per_s"), 1e3);
    EXPECT_DOUBLE_EQ(180.0 / unitsPerSi("angle_tolerance_deg"), 3.14159265358979323846);
    EXPECT_EQ(unitsPerSi("stiffness_N_per_m"), 1.0);
    EXPECT_EQ(unitsPerSi("hold_s"), 1.0);
}

TEST(KeyTable, SuggestsTheWordThatWasMeant) {
    // Truth: closed form: one slip, a missing unit, and a word that is like none.
    const std::vector<std::string_view> words{"stiffness_N_per_m", "tolerance_um", "mode"};
    EXPECT_EQ(closestWord("stifness_N_per_m", words), "stiffness_N_per_m");
    EXPECT_EQ(closestWord("tolerance", words), "tolerance_um");
    EXPECT_EQ(closestWord("gravity", words), std::nullopt);
}

}  // namespace
}  // namespace passung::protocol
