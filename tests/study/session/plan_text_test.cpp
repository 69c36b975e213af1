#include "study/session/plan_text.h"

#include <gtest/gtest.h>

#include "study/session/participant_order.h"

namespace passung::session {
namespace {

plan::StudyPlan smallPlan() {
    plan::StudyPlan plan;
    plan.name = "demo";
    plan.version = "1";
    plan.title = "A demonstration";
    plan.seed = 42;
    plan.participants = 4;
    plan.factors = {{"method", plan::FactorKind::Within, "", {{"a"}, {"b"}, {"c"}, {"d"}}}};
    for (const char* label : {"a", "b", "c", "d"}) {
        plan::Condition condition;
        condition.name = label;
        condition.levels = {plan.conditions.size()};
        condition.device = "arm";
        condition.task.timeout = 30.0;
        plan.conditions.push_back(condition);
    }
    plan.blocks = {{"practice", plan::Phase::Practice, 1, plan::BlockOrder::Random, 2},
                   {"main", plan::Phase::Main, 3, plan::BlockOrder::Williams, 0}};
    return plan;
}

TEST(PlanText, ShowsTheWholeDesign) {
    // Truth: independent program (Python 3.11, the streams and squares from their definitions) for the rows,
    // one further with each pass; 14 trials of at most 30 s are 7 min.
    EXPECT_EQ(*describePlan(smallPlan(), 2), R"(A demonstration
study demo, version 1, seed 42, 4 participants planned

Factors (within participants)
  method  a, b, c, d

Conditions
    1  a  (device arm, 1000 N/m, 1 Nm/rad)
    2  b  (device arm, 1000 N/m, 1 Nm/rad)
    3  c  (device arm, 1000 N/m, 1 Nm/rad)
    4  d  (device arm, 1000 N/m, 1 Nm/rad)

Blocks
  practice  practice, order random, 2 trials x 1 repetition
  main      main, order williams, 4 trials x 3 repetitions

Orders (numbers of conditions; blocks parted by |)
  P001  2 1 | 2 3 4 1, 3 1 2 4, 1 4 3 2
  P002  4 2 | 3 1 2 4, 1 4 3 2, 4 2 1 3
2 is not a multiple of 4: position counts 0-1, neighbour counts 0-1; balanced with 4.

Duration
  14 trials a participant, 7.0 min if each lasts to its time-out and rests are as short as they may be;
  ways to the start, repeated attempts, questionnaires and instructions come on top
)");
}

TEST(PlanText, RepeatsTheWarnings) {
    // Truth: invariant: what the reader warned of must not get lost.
    auto plan = smallPlan();
    plan.warnings = {"too few"};
    EXPECT_NE(describePlan(plan, 1)->find("\nwarning: too few\n"), std::string::npos);
}

TEST(PlanText, WarnsOfUnbalancedNumbers) {
    // Truth: closed form: four conditions need multiples of four; order "listed" needs none.
    auto plan = smallPlan();
    EXPECT_TRUE(planWarnings(plan).empty());
    plan.participants = 6;
    EXPECT_EQ(planWarnings(plan),
              std::vector<std::string>{"study.participants = 6 is not a multiple of the 4 rows of the Williams square: "
                                       "orders will not be balanced"});
    plan.blocks[1].order = plan::BlockOrder::Listed;
    EXPECT_TRUE(planWarnings(plan).empty());
}

TEST(ParticipantOrder, FollowsTheBlocksOfTheProtocol) {
    // Truth: closed form: block 0 has 2 practice trials, block 1 three passes of four.
    const auto trials = *planTrials(smallPlan(), {}, "P001");
    ASSERT_EQ(trials.size(), 14u);
    EXPECT_EQ(trials[1].phase, "practice");
    EXPECT_EQ(trials[2].phase, "main");
    EXPECT_EQ(trials[2].block, "main");
    EXPECT_EQ(trials[13].repetition, 3);
}

TEST(PlanText, ListsWhatIsAskedAndWhen) {
    // Truth: closed form; the words are a regression
    auto plan = smallPlan();
    EXPECT_EQ(describePlan(plan, 1)->find("Questionnaires"), std::string::npos);
    for (const auto moment : {plan::Moment::SessionEnd, plan::Moment::AfterBlock, plan::Moment::AfterTrial}) {
        plan::PlannedQuestionnaire planned;
        planned.definition.key = "ssq";
        planned.definition.version = "1.0";
        planned.definition.items.resize(16);
        planned.language = "de";
        planned.moment = moment;
        if (moment == plan::Moment::AfterTrial) planned.block = "practice";
        plan.questionnaires.push_back(planned);
    }
    EXPECT_NE(describePlan(plan, 1)->find("\nQuestionnaires\n"
                                          "  ssq 1.0  session_end, de, 16 items\n"
                                          "  ssq 1.0  after_block of every main block, de, 16 items\n"
                                          "  ssq 1.0  after_trial of block practice, de, 16 items\n"),
              std::string::npos);
}

}  // namespace
}  // namespace passung::session
