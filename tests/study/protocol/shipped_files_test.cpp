#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/scene/contact_geometry.h"
#include "devices/simulated/presets.h"
#include "study/design/trial_order.h"
#include "study/measures/measures.h"
#include "study/protocol/protocol_reader.h"
#include "study/protocol/trial_types.h"
#include "tests/study/protocol/known_names.h"
#include "tests/support/length.h"

namespace passung::protocol {
namespace {

Result<plan::StudyPlan> readShipped(const std::string& name) {
    return readProtocol(PASSUNG_SOURCE_DIR "/protocols/" + name, knownDevices(), knownMeasures());
}

TEST(ShippedFiles, PegInHoleAsksForConsentInTwoLanguages) {
    // Truth: closed form: what the study's own comments say.
    const auto plan = readShipped("peg_in_hole/study.toml");
    ASSERT_TRUE(plan) << toString(plan.errors()[0]);
    std::string clauses;
    for (const plan::ConsentClause& clause : plan->consent) {
        clauses += clause.clause + (clause.required ? " " : "? ");
        ASSERT_EQ(clause.texts.size(), 2u) << clause.clause;
        for (const auto& [language, text] : clause.texts) {
            EXPECT_EQ(text.find_first_of("\n\\"), std::string::npos) << "one paragraph: " << text;
            const bool umlauts = std::any_of(text.begin(), text.end(), [](char c) { return (c & 0x80) != 0; });
            EXPECT_EQ(umlauts, language == "de") << text;
        }
    }
    EXPECT_EQ(clauses, "taking_part data_use sharing? ");
}

/// The gearbox with another factor in place of its own.
Result<plan::StudyPlan> gearboxVarying(const std::string& key, const std::string& levels) {
    const std::string file = PASSUNG_SOURCE_DIR "/protocols/gearbox_assembly/study.toml";
    std::ifstream in(file);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::string own = "key = \"contact.stiffness_N_per_m\"\nlevels = [\"0.5 max\", \"max\"]";
    const std::size_t at = text.find(own);
    if (at == std::string::npos) throw std::runtime_error(file + ": no such factor");
    text.replace(at, own.size(), "key = \"" + key + "\"\nlevels = " + levels);
    return readProtocolText(text, file, knownDevices(), knownMeasures());
}

TEST(ShippedFiles, AFactorReachesAStepAndAFurtherHandByTheirNames) {
    // Truth: closed form: each level, in metres, where the file's own lines put the step and the hand.
    const auto steps = gearboxVarying("task.step.key_in.position_tolerance_mm", "[1.2, 0.4]");
    ASSERT_TRUE(steps) << toString(steps.errors()[0]);
    ASSERT_EQ(steps->conditions.size(), 2u);
    const auto tolerance = [&](std::size_t condition, std::size_t step) {
        return steps->conditions[condition].scene.effects.pick.steps.at(step).position_tolerance;
    };
    EXPECT_DOUBLE_EQ(tolerance(0, 6), 1.2e-3);
    EXPECT_DOUBLE_EQ(tolerance(1, 6), 0.4e-3);
    for (const std::size_t other : {0u, 3u, 5u}) EXPECT_EQ(tolerance(0, other), tolerance(1, other));

    const auto paths = gearboxVarying("task.step.key_in.path_mm", "[80.5, 92]");
    ASSERT_TRUE(paths) << toString(paths.errors()[0]);
    for (const std::size_t i : {0u, 1u}) {
        const auto& asked = std::get<plan::AssemblyTask>(paths->conditions[i].task.form).steps;
        EXPECT_DOUBLE_EQ(asked.at(6).free_path.value_or(0.0), i == 0 ? 0.0805 : 0.092);
        EXPECT_FALSE(asked.at(3).free_path);
    }

    const auto hands = gearboxVarying("hand.left.start_gate.hold_ms", "[200, 350]");
    ASSERT_TRUE(hands) << toString(hands.errors()[0]);
    ASSERT_EQ(hands->conditions.size(), 2u);
    for (const std::size_t i : {0u, 1u}) {
        EXPECT_EQ(hands->conditions[i].scene.hand(0).start_gate.hold_ticks, 200);
        EXPECT_EQ(hands->conditions[i].scene.hand(1).start_gate.hold_ticks, i == 0 ? 200 : 350);
    }

    for (const auto& [key, message] : {std::pair("task.step.lid.position_tolerance_mm", "the task has no step"),
                                       std::pair("hand.third.registration.scale", "the scene has no further hand"),
                                       std::pair("task.step.key_in.position_tolerance", "unknown key")}) {
        const auto wrong = gearboxVarying(key, "[1, 2]");
        ASSERT_FALSE(wrong) << key;
        EXPECT_NE(toString(wrong.errors()[0]).find(message), std::string::npos) << toString(wrong.errors()[0]);
    }
}

double radialClearance(const plan::Condition& condition) {
    const auto& shape = [&](std::size_t i) -> const shape::Shape& {
        return std::get<shape::Shape>(condition.scene.parts[i].geometry);
    };
    return 0.5 * (std::get<shape::BorePlate>(shape(0)).bore_diameter - std::get<shape::Peg>(shape(1)).diameter);
}

TEST(ShippedFiles, PegInHoleHasItsTwelveConditionsAndTheGeometryOfOne) {
    // Truth: closed form: 2 clearances x 3 methods x 2 stiffnesses, and one of them from fields, as the study's own
    // comment says.
    const auto plan = readShipped("peg_in_hole/study.toml");
    ASSERT_TRUE(plan) << toString(plan.errors()[0]);
    EXPECT_TRUE(plan->warnings.empty());
    ASSERT_EQ(plan->conditions.size(), 13u);
    using enum scene::ContactMethod;
    constexpr scene::ContactMethod kMethods[]{Penalty, GodObjectHeuristic, GodObject};
    const auto sigma7 = simulated::describe(*simulated::findPreset("sigma7"));
    for (std::size_t i = 0; i < 12; ++i) {
        const auto& condition = plan->conditions[i];
        EXPECT_NEAR(radialClearance(condition), i < 6 ? 0.5e-3 : 0.1e-3, 1e-12);
        EXPECT_EQ(condition.scene.contact.method, kMethods[i / 2 % 3]);
        EXPECT_DOUBLE_EQ(condition.scene.contact.stiffness, (i % 2 == 0 ? 0.5 : 1.0) * sigma7.stable_stiffness_N_per_m);
        EXPECT_EQ(condition.device, "sigma7");
        EXPECT_EQ(condition.scene.parts[1].X_WP.p, Vec3(0.020, 0, 0.030));
        EXPECT_EQ(condition.scene.start_gate.hold_ticks, 200);
    }
    EXPECT_EQ(plan->conditions[0].name, "0.5/penalty/0.5 max/field");
    EXPECT_EQ(plan->conditions[9].name, "0.1/god_object_heuristic/max/closed_form");
    EXPECT_EQ(plan->conditions[11].name, "0.1/god_object/max/closed_form");
    EXPECT_EQ(plan->conditions[12].name, "0.1/god_object/max/field");
    for (std::size_t i = 0; i < 13; ++i)
        EXPECT_EQ(scene::geometryOf(plan->conditions[i].scene).geometry,
                  i < 12 && i / 2 % 3 != 0 ? scene::Geometry::ClosedForm : scene::Geometry::Field);
    // All but the geometry is that of the condition before.
    EXPECT_EQ(plan->conditions[12].scene.contact.stiffness, plan->conditions[11].scene.contact.stiffness);
    EXPECT_EQ(plan->conditions[12].scene.contact.method, plan->conditions[11].scene.contact.method);
    EXPECT_EQ(radialClearance(plan->conditions[12]), radialClearance(plan->conditions[11]));
    ASSERT_EQ(plan->blocks.size(), 3u);
    EXPECT_EQ(plan->blocks[0].trials, 2);
    EXPECT_EQ(plan->blocks[1].repetitions, 2);
    EXPECT_EQ(plan->blocks[2].conditions, (std::vector<std::size_t>{11, 12}));
    std::vector<std::size_t> twelve(12);
    std::iota(twelve.begin(), twelve.end(), std::size_t{0});
    for (const std::size_t b : {0u, 1u}) EXPECT_EQ(plan->blocks[b].conditions, twelve) << plan->blocks[b].name;
    const auto design = plan::designOf(*plan);
    EXPECT_EQ(design::sequencesOf(design), 12u) << "the last block is in random order: 12 participants stay balanced";
    int begins_with_field = 0;
    for (std::size_t slot = 0; slot < 12; ++slot) {
        const auto trials =
            *design::planSession(design, {plan->name, plan->seed, "P" + std::to_string(slot), slot, 0, 1});
        ASSERT_EQ(trials.size(), 2u + 24u + 2u);
        EXPECT_EQ(trials[26].condition + trials[27].condition, 11u + 12u);
        begins_with_field += trials[26].condition == 12u;
    }
    EXPECT_GT(begins_with_field, 1);
    EXPECT_LT(begins_with_field, 11);
    std::vector<std::string> possible;  // all but those of other types of trial and of a secondary task
    for (const auto& definition : measures::definitions()) {
        const auto types = typesWith(definition.name);
        if (definition.name.starts_with("secondary_")) continue;
        if (types.empty() || types.front()->name == "peg_in_hole") possible.push_back(definition.name);
    }
    EXPECT_EQ(plan->measures, possible);
}

TEST(ShippedFiles, PegInHoleAsksForLoadAfterItsMainBlockAndForTheContactOfEachCondition) {
    // Truth: closed form: as the study's own comments say.
    const auto plan = readShipped("peg_in_hole/study.toml");
    ASSERT_TRUE(plan);
    ASSERT_EQ(plan->questionnaires.size(), 2u);
    EXPECT_EQ(plan->questionnaires[0].definition.key, "nasa_tlx_raw");
    EXPECT_EQ(plan->questionnaires[0].moment, plan::Moment::AfterBlock);
    EXPECT_EQ(plan->questionnaires[1].definition.key, "contact_perception");
    EXPECT_EQ(plan->questionnaires[1].moment, plan::Moment::AfterCondition);
    for (const auto& asked : plan->questionnaires) EXPECT_EQ(asked.block, "main");
}

TEST(ShippedFiles, DesignsGivesEveryCombinationEquallyOften) {
    // Truth: closed form: 8 rows x 2 groups; of 32 conditions everybody meets 4, catch trials apart, in the main block,
    // each half of the chamfers; over all, each of the 16 without catch stands there 16 x 4 / 16 = 4 times.
    const auto plan = readShipped("designs/study.toml");
    ASSERT_TRUE(plan) << toString(plan.errors()[0]);
    ASSERT_EQ(plan->warnings.size(), 1u) << "no actuator gives the vibration";
    EXPECT_NE(plan->warnings[0].find("\"vibrotactile\""), std::string::npos);
    EXPECT_EQ(plan->conditions.size(), 32u);
    EXPECT_EQ(plan::groupNames(*plan), (std::vector<std::string>{"proxy", "device"}));
    EXPECT_EQ(plan::sessionsOf(*plan), 2);
    const auto design = plan::designOf(*plan);
    ASSERT_EQ(design::sequencesOf(design), 8u);
    std::map<std::size_t, int> seen;
    for (std::size_t group = 0; group < 2; ++group)
        for (std::size_t slot = 0; slot < 8; ++slot) {
            const auto first = *design::planSession(design, {plan->name, plan->seed, "P001", slot, group, 1});
            const auto second = *design::planSession(design, {plan->name, plan->seed, "P001", slot, group, 2});
            ASSERT_EQ(first.size(), 1u + 4u + 2u);
            ASSERT_EQ(second.size(), 8u);
            for (std::size_t i = 0; i < first.size(); ++i) {
                EXPECT_EQ(plan->conditions[first[i].condition].levels[2], group);
                EXPECT_EQ(first[i].phase == "catch", plan->conditions[first[i].condition].levels[4] == 1);
                if (first[i].phase == "main") ++seen[first[i].condition];
            }
            for (std::size_t i = 1; i < second.size(); ++i) EXPECT_NE(second[i].condition, second[i - 1].condition);
        }
    EXPECT_EQ(seen.size(), 16u);
    for (const auto& [condition, count] : seen) EXPECT_EQ(count, 4) << plan->conditions[condition].name;
}

TEST(ShippedFiles, RealVsVirtualHasItsEnvironmentsThreeTimesInBalancedOrders) {
    // Truth: closed form: 6 environments and the secondary task alone, in three blocks of which two change a key; over
    // the 6 rows of the square each environment stands at each position of a pass once.
    const auto plan = readShipped("real_vs_virtual/study.toml");
    ASSERT_TRUE(plan) << toString(plan.errors()[0]);
    ASSERT_EQ(plan->warnings.size(), 1u) << "no actuator gives the vibration";
    EXPECT_NE(plan->warnings[0].find("\"vibrotactile\""), std::string::npos);
    ASSERT_EQ(plan->conditions.size(), 21u);
    const plan::Condition &real = plan->conditions[0], &kinesthetic = plan->conditions[4],
                          &alone = plan->conditions[13];
    EXPECT_EQ(real.timed_by, plan::TimedBy::Experimenter);
    EXPECT_FALSE(real.scene.display_wrench);
    EXPECT_TRUE(kinesthetic.scene.display_wrench);
    EXPECT_EQ(alone.name, "alone@secondary_task");
    EXPECT_EQ(alone.timed_by, plan::TimedBy::Clock);
    for (std::size_t i = 0; i < 21; ++i) {
        EXPECT_EQ(plan->conditions[i].secondary.any(), i / 7 == 1) << plan->conditions[i].name;
        EXPECT_EQ(plan->conditions[i].cues.masking_noise, i / 7 == 2) << plan->conditions[i].name;
    }
    EXPECT_EQ(plan->languages, (std::vector<std::string>{"en", "de"}));
    EXPECT_EQ(plan->instructions.size(), 5u);
    EXPECT_EQ(plan->pictures.size(), 1u);
    const auto design = plan::designOf(*plan);
    ASSERT_EQ(design::sequencesOf(design), 6u);
    std::map<std::pair<std::int64_t, std::size_t>, int> seen;  // position in the regular block, condition
    for (std::size_t slot = 0; slot < 6; ++slot) {
        const auto trials = *design::planSession(design, {plan->name, plan->seed, "P001", slot, 0, 1});
        for (const auto& trial : trials)
            if (trial.block == "regular") ++seen[{trial.trial_in_block, trial.condition}];
    }
    EXPECT_EQ(seen.size(), 12u * 6u);
    for (const auto& [place, count] : seen) EXPECT_EQ(count, 1);
}

TEST(ShippedFiles, NarrowPassageBalancesItsSixConditionsOver42People) {
    // Truth: closed form: 3 kinds of feedback x 2 passages; a Williams square of order 6 has 6 rows, 42 = 7 x 6, so
    // that each condition stands 7 times at each position of a pass.
    const auto plan = readShipped("narrow_passage/study.toml");
    ASSERT_TRUE(plan) << toString(plan.errors()[0]);
    ASSERT_EQ(plan->warnings.size(), 1u);
    EXPECT_NE(plan->warnings[0].find("\"vibrotactile\""), std::string::npos);
    ASSERT_EQ(plan->conditions.size(), 6u);
    EXPECT_EQ(plan->participants, 42);
    for (std::size_t i = 0; i < 6; ++i) {
        const plan::Condition& condition = plan->conditions[i];
        EXPECT_EQ(condition.scene.display_wrench, i / 2 == 2) << condition.name;
        EXPECT_EQ(condition.cues.visual, i / 2 == 0);
        EXPECT_EQ(condition.cues.vibrotactile, i / 2 == 1);
        EXPECT_NEAR(radialClearance(condition), i % 2 == 0 ? 3e-3 : 0.5e-3, 1e-12);
        EXPECT_NEAR(std::get<plan::NarrowPassageTask>(condition.task.form).width, i % 2 == 0 ? 0.026 : 0.021, 1e-12);
    }
    const auto design = plan::designOf(*plan);
    ASSERT_EQ(design::sequencesOf(design), 6u);
    std::map<std::pair<std::int64_t, std::size_t>, int> seen;
    for (std::size_t slot = 0; slot < 42; ++slot) {
        const auto session = design::planSession(design, {plan->name, plan->seed, "S001", slot, 0, 1});
        ASSERT_TRUE(session);
        for (const auto& trial : *session)
            if (trial.block == "main") ++seen[{trial.trial_in_block, trial.condition}];
    }
    EXPECT_EQ(seen.size(), 12u * 6u);
    for (const auto& [place, count] : seen) EXPECT_EQ(count, 7);
}

TEST(ShippedFiles, HiddenOffsetMovesOnlyTheTouchedPlate) {
    // Truth: closed form: the drawn plate is at pose + shown_offset, which is where study.toml has it. That has a
    // condition more, and the geometry in its names.
    const auto plain = readShipped("peg_in_hole/study.toml");
    const auto hidden = readShipped("peg_in_hole/hidden_offset.toml");
    ASSERT_TRUE(plain && hidden);
    ASSERT_EQ(hidden->conditions.size() + 1, plain->conditions.size());
    for (std::size_t i = 0; i < hidden->conditions.size(); ++i) {
        const auto& a = plain->conditions[i];
        const auto& b = hidden->conditions[i];
        EXPECT_EQ(a.name, b.name + "/" + scene::geometryName(scene::geometryOf(b.scene).geometry));
        EXPECT_DOUBLE_EQ((b.scene.parts[0].X_WP.p - a.scene.parts[0].X_WP.p).norm(), 0.003);
        EXPECT_EQ(b.scene.parts[0].X_WP.p + b.scene.parts[0].shown_offset, a.scene.parts[0].X_WP.p);
        EXPECT_EQ(a.scene.parts[1].X_WP.p, b.scene.parts[1].X_WP.p);
        EXPECT_EQ(a.scene.contact.stiffness, b.scene.contact.stiffness);
    }
}

/// The study with `change` done to a line must be read or refused with a place, whatever it does to it. By default
/// every third line from `first` on in turn, so that three changes that follow each other reach all; PASSUNG_LONG=1:
/// every line.
template <class Change>
void expectSafe(std::size_t first, Change change) {
    const std::size_t every = test::atFullLength() ? 1 : 3;
    const auto plan = readShipped("peg_in_hole/study.toml");
    ASSERT_TRUE(plan);
    const std::string& text = plan->source_text;
    const auto devices = knownDevices();
    const auto measures = knownMeasures();
    std::size_t refused = 0, number = 0;
    for (std::size_t start = 0; start < text.size();) {
        const std::size_t end = text.find('\n', start) + 1;
        if (number++ % every != first % every) {
            start = end;
            continue;
        }
        const auto line = text.substr(start, end - start);
        const auto damaged = text.substr(0, start) + change(line) + text.substr(end);
        start = end;
        if (damaged == text) continue;  // a comment has no value
        const auto read = readProtocolText(damaged, "damaged.toml", devices, measures);
        if (!read) {
            ++refused;
            for (const auto& error : read.errors()) {
                EXPECT_EQ(error.file, "damaged.toml") << damaged;
                EXPECT_GE(error.line, 1) << toString(error);
            }
        }
    }
    EXPECT_GT(every * refused, 20u) << "the damage must not go unnoticed";
}

TEST(ShippedFiles, AnyDamagedLineIsReadOrRefusedWithAPlace) {
    // Truth: invariant: no input may crash the reader, and no error may lack its place.
    expectSafe(0, [](const std::string&) { return std::string(); });
    expectSafe(1, [](const std::string& line) { return line + line; });
    const auto valueBecomes = [](const char* value) {
        return [value](const std::string& line) {
            const auto equals = line.find(" = ");
            return line[0] == '#' || equals == std::string::npos ? line : line.substr(0, equals + 3) + value + "\n";
        };
    };
    std::size_t first = 2;
    for (const char* value : {"nan", "-1", "1e400", "\"x\"", "[]", "[{}, {}]", "{}", "true", "1979-05-27", "[[[]]]"})
        expectSafe(first++, valueBecomes(value));
}

}  // namespace
}  // namespace passung::protocol
