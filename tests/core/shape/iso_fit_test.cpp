#include "core/shape/iso_fit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace passung::shape {
namespace {

/// Deviations in µm, "+28/+15", with at most one decimal.
std::string deviationsOf(const std::string& tolerance_class, double nominal_mm) {
    const auto deviations = limitDeviations(tolerance_class, 1e-3 * nominal_mm);
    if (!deviations) return toString(deviations.errors()[0]);
    const auto text = [](double metres) {
        const long tenths = std::lround(1e7 * metres);
        std::string digits = std::to_string(std::abs(tenths) / 10);
        if (tenths % 10 != 0) digits += '.' + std::to_string(std::abs(tenths) % 10);
        return (tenths > 0 ? "+" : tenths < 0 ? "-" : "") + digits;
    };
    return text(deviations->upper) + "/" + text(deviations->lower);
}

std::string keyOf(const std::string& tolerance_class, double nominal_mm) {
    const auto deviations = limitDeviations(tolerance_class, 1e-3 * nominal_mm);
    return deviations ? "" : deviations.errors()[0].key;
}

TEST(IsoFit, HasTheStandardsDeviationsFromThreeTo400Millimetres) {
    // Truth: independent program (isofits 1.0 of the Python package index, whose tables iso_holes.csv and
    // iso_shafts.csv are those of ISO 286-2): one size of each step.
    constexpr std::array kSizes{5.0, 8.0, 14.0, 25.0, 45.0, 60.0, 100.0, 150.0, 200.0, 300.0, 380.0};
    struct Row {
        std::string name;
        std::array<std::string, kSizes.size()> deviations;
    };
    const std::vector<Row> rows{
        {"d6",
         {"-30/-38", "-40/-49", "-50/-61", "-65/-78", "-80/-96", "-100/-119", "-120/-142", "-145/-170", "-170/-199",
          "-190/-222", "-210/-246"}},
        {"e6",
         {"-20/-28", "-25/-34", "-32/-43", "-40/-53", "-50/-66", "-60/-79", "-72/-94", "-85/-110", "-100/-129",
          "-110/-142", "-125/-161"}},
        {"f7",
         {"-10/-22", "-13/-28", "-16/-34", "-20/-41", "-25/-50", "-30/-60", "-36/-71", "-43/-83", "-50/-96", "-56/-108",
          "-62/-119"}},
        {"g6",
         {"-4/-12", "-5/-14", "-6/-17", "-7/-20", "-9/-25", "-10/-29", "-12/-34", "-14/-39", "-15/-44", "-17/-49",
          "-18/-54"}},
        {"h4", {"0/-4", "0/-4", "0/-5", "0/-6", "0/-7", "0/-8", "0/-10", "0/-12", "0/-14", "0/-16", "0/-18"}},
        {"h5", {"0/-5", "0/-6", "0/-8", "0/-9", "0/-11", "0/-13", "0/-15", "0/-18", "0/-20", "0/-23", "0/-25"}},
        {"h12",
         {"0/-120", "0/-150", "0/-180", "0/-210", "0/-250", "0/-300", "0/-350", "0/-400", "0/-460", "0/-520",
          "0/-570"}},
        {"js6",
         {"+4/-4", "+4.5/-4.5", "+5.5/-5.5", "+6.5/-6.5", "+8/-8", "+9.5/-9.5", "+11/-11", "+12.5/-12.5", "+14.5/-14.5",
          "+16/-16", "+18/-18"}},
        {"k6",
         {"+9/+1", "+10/+1", "+12/+1", "+15/+2", "+18/+2", "+21/+2", "+25/+3", "+28/+3", "+33/+4", "+36/+4", "+40/+4"}},
        {"m6",
         {"+12/+4", "+15/+6", "+18/+7", "+21/+8", "+25/+9", "+30/+11", "+35/+13", "+40/+15", "+46/+17", "+52/+20",
          "+57/+21"}},
        {"n6",
         {"+16/+8", "+19/+10", "+23/+12", "+28/+15", "+33/+17", "+39/+20", "+45/+23", "+52/+27", "+60/+31", "+66/+34",
          "+73/+37"}},
        {"p6",
         {"+20/+12", "+24/+15", "+29/+18", "+35/+22", "+42/+26", "+51/+32", "+59/+37", "+68/+43", "+79/+50", "+88/+56",
          "+98/+62"}},
        {"r6",
         {"+23/+15", "+28/+19", "+34/+23", "+41/+28", "+50/+34", "+60/+41", "+73/+51", "+90/+65", "+106/+77",
          "+130/+98", "+150/+114"}},
        {"E12",
         {"+140/+20", "+175/+25", "+212/+32", "+250/+40", "+300/+50", "+360/+60", "+422/+72", "+485/+85", "+560/+100",
          "+630/+110", "+695/+125"}},
        {"F8",
         {"+28/+10", "+35/+13", "+43/+16", "+53/+20", "+64/+25", "+76/+30", "+90/+36", "+106/+43", "+122/+50",
          "+137/+56", "+151/+62"}},
        {"G7",
         {"+16/+4", "+20/+5", "+24/+6", "+28/+7", "+34/+9", "+40/+10", "+47/+12", "+54/+14", "+61/+15", "+69/+17",
          "+75/+18"}},
        {"H7", {"+12/0", "+15/0", "+18/0", "+21/0", "+25/0", "+30/0", "+35/0", "+40/0", "+46/0", "+52/0", "+57/0"}},
        {"H9", {"+30/0", "+36/0", "+43/0", "+52/0", "+62/0", "+74/0", "+87/0", "+100/0", "+115/0", "+130/0", "+140/0"}},
        {"H10",
         {"+48/0", "+58/0", "+70/0", "+84/0", "+100/0", "+120/0", "+140/0", "+160/0", "+185/0", "+210/0", "+230/0"}},
        {"H11",
         {"+75/0", "+90/0", "+110/0", "+130/0", "+160/0", "+190/0", "+220/0", "+250/0", "+290/0", "+320/0", "+360/0"}},
        {"JS8",
         {"+9/-9", "+11/-11", "+13.5/-13.5", "+16.5/-16.5", "+19.5/-19.5", "+23/-23", "+27/-27", "+31.5/-31.5",
          "+36/-36", "+40.5/-40.5", "+44.5/-44.5"}},
        {"K6",
         {"+2/-6", "+2/-7", "+2/-9", "+2/-11", "+3/-13", "+4/-15", "+4/-18", "+4/-21", "+5/-24", "+5/-27", "+7/-29"}},
        {"K7",
         {"+3/-9", "+5/-10", "+6/-12", "+6/-15", "+7/-18", "+9/-21", "+10/-25", "+12/-28", "+13/-33", "+16/-36",
          "+17/-40"}},
        {"K8",
         {"+5/-13", "+6/-16", "+8/-19", "+10/-23", "+12/-27", "+14/-32", "+16/-38", "+20/-43", "+22/-50", "+25/-56",
          "+28/-61"}},
        {"M6",
         {"-1/-9", "-3/-12", "-4/-15", "-4/-17", "-4/-20", "-5/-24", "-6/-28", "-8/-33", "-8/-37", "-9/-41",
          "-10/-46"}},
        {"M7", {"0/-12", "0/-15", "0/-18", "0/-21", "0/-25", "0/-30", "0/-35", "0/-40", "0/-46", "0/-52", "0/-57"}},
        {"M8",
         {"+2/-16", "+1/-21", "+2/-25", "+4/-29", "+5/-34", "+5/-41", "+6/-48", "+8/-55", "+9/-63", "+9/-72",
          "+11/-78"}},
        {"N6",
         {"-5/-13", "-7/-16", "-9/-20", "-11/-24", "-12/-28", "-14/-33", "-16/-38", "-20/-45", "-22/-51", "-25/-57",
          "-26/-62"}},
        {"N7",
         {"-4/-16", "-4/-19", "-5/-23", "-7/-28", "-8/-33", "-9/-39", "-10/-45", "-12/-52", "-14/-60", "-14/-66",
          "-16/-73"}},
        {"N8",
         {"-2/-20", "-3/-25", "-3/-30", "-3/-36", "-3/-42", "-4/-50", "-4/-58", "-4/-67", "-5/-77", "-5/-86",
          "-5/-94"}},
        {"P6",
         {"-9/-17", "-12/-21", "-15/-26", "-18/-31", "-21/-37", "-26/-45", "-30/-52", "-36/-61", "-41/-70", "-47/-79",
          "-51/-87"}},
        {"P7",
         {"-8/-20", "-9/-24", "-11/-29", "-14/-35", "-17/-42", "-21/-51", "-24/-59", "-28/-68", "-33/-79", "-36/-88",
          "-41/-98"}},
        {"P8",
         {"-12/-30", "-15/-37", "-18/-45", "-22/-55", "-26/-65", "-32/-78", "-37/-91", "-43/-106", "-50/-122",
          "-56/-137", "-62/-151"}},
    };
    for (const auto& row : rows)
        for (std::size_t i = 0; i < kSizes.size(); ++i)
            EXPECT_EQ(deviationsOf(row.name, kSizes[i]), row.deviations[i]) << row.name << " at " << kSizes[i];
}

TEST(IsoFit, HasTheFinerStepsOfInterferenceFits) {
    // Truth: independent program (isofits 1.0, as above) for r6; s6 as in the tables of ISO 286-2.
    constexpr std::array kSizes{60.0, 70.0, 90.0, 110.0, 130.0, 150.0, 170.0, 190.0, 210.0, 240.0, 270.0, 300.0, 340.0};
    const std::array<std::string, kSizes.size()> r6{"+60/+41",  "+62/+43",  "+73/+51",  "+76/+54",  "+88/+63",
                                                    "+90/+65",  "+93/+68",  "+106/+77", "+109/+80", "+113/+84",
                                                    "+126/+94", "+130/+98", "+144/+108"};
    const std::array<std::string, kSizes.size()> s6{"+72/+53",   "+78/+59",   "+93/+71",   "+101/+79",  "+117/+92",
                                                    "+125/+100", "+133/+108", "+151/+122", "+159/+130", "+169/+140",
                                                    "+190/+158", "+202/+170", "+226/+190"};
    for (std::size_t i = 0; i < kSizes.size(); ++i) {
        EXPECT_EQ(deviationsOf("r6", kSizes[i]), r6[i]) << kSizes[i];
        EXPECT_EQ(deviationsOf("s6", kSizes[i]), s6[i]) << kSizes[i];
    }
}

TEST(IsoFit, HasTheStandardsDeviationsOfTheSmallestAndTheLargestStep) {
    // Truth: closed form: the tables of ISO 286-2 up to 3 mm and from 400 to 500 mm, and classes in use for keys.
    struct Row {
        std::string name;
        double size;
        std::string deviations;
    };
    const std::vector<Row> rows{
        {"H7", 2, "+10/0"},      {"g6", 2, "-2/-8"},      {"f7", 2, "-6/-16"},      {"k6", 2, "+6/0"},
        {"n6", 2, "+10/+4"},     {"p6", 2, "+12/+6"},     {"s6", 2, "+20/+14"},     {"K7", 2, "0/-10"},
        {"M7", 2, "-2/-12"},     {"N7", 2, "-4/-14"},     {"N9", 2, "-4/-29"},      {"P7", 2, "-6/-16"},
        {"H7", 450, "+63/0"},    {"g6", 450, "-20/-60"},  {"f7", 450, "-68/-131"},  {"k6", 450, "+45/+5"},
        {"n6", 450, "+80/+40"},  {"p6", 450, "+108/+68"}, {"s6", 450, "+272/+232"}, {"K7", 450, "+18/-45"},
        {"M7", 450, "0/-63"},    {"N7", 450, "-17/-80"},  {"P7", 450, "-45/-108"},  {"H8", 500, "+97/0"},
        {"N9", 20, "0/-52"},     {"P9", 8, "-15/-51"},    {"JS9", 8, "+18/-18"},    {"D10", 8, "+98/+40"},
        {"D10", 20, "+149/+65"}, {"E9", 20, "+92/+40"},   {"d9", 20, "-65/-117"},   {"k8", 20, "+33/0"},
        {"H01", 20, "+0.6/0"},   {"h0", 20, "0/-1"},      {"H1", 20, "+1.5/0"},     {"H2", 20, "+2.5/0"},
        {"H13", 20, "+330/0"},   {"H18", 20, "+3300/0"},  {"h15", 100, "0/-1400"},  {"K3", 20, "-0.5/-4.5"},
    };
    for (const auto& row : rows) EXPECT_EQ(deviationsOf(row.name, row.size), row.deviations) << row.name << row.size;
}

TEST(IsoFit, TakesTheStepThatEndsAtASize) {
    // Truth: closed form: a step reaches up to and including its limit, whatever a conversion of units rounds.
    EXPECT_EQ(deviationsOf("H7", 18.0), "+18/0");
    EXPECT_EQ(deviationsOf("H7", 18.001), "+21/0");
    for (const double limit : {3.0, 6.0, 10.0, 18.0, 30.0, 50.0, 80.0, 120.0, 180.0, 250.0, 315.0, 400.0, 500.0}) {
        const std::string exact = deviationsOf("H7", limit);
        EXPECT_EQ(deviationsOf("H7", limit * (1 + 1e-15)), exact) << limit;
        EXPECT_EQ(deviationsOf("H7", limit * (1 - 1e-15)), exact) << limit;
    }
}

TEST(IsoFit, GivesTheDiametersOfEachClearance) {
    // Truth: closed form. 20 H7/g6: hole 20.000 to 20.021, shaft 19.980 to 19.993 mm: clearance 7 to 41 µm, mean 24 µm.
    const auto fit = parseFit("H7/g6");
    ASSERT_TRUE(fit);
    const auto clearance = [&](Clearance which) {
        return *holeDiameter(*fit, 0.02, which) - *shaftDiameter(*fit, 0.02, which);
    };
    EXPECT_NEAR(*holeDiameter(*fit, 0.02, Clearance::Min), 0.020, 1e-15);
    EXPECT_NEAR(*holeDiameter(*fit, 0.02, Clearance::Max), 0.020021, 1e-15);
    EXPECT_NEAR(*shaftDiameter(*fit, 0.02, Clearance::Min), 0.019993, 1e-15);
    EXPECT_NEAR(*shaftDiameter(*fit, 0.02, Clearance::Max), 0.019980, 1e-15);
    EXPECT_NEAR(clearance(Clearance::Min), 7e-6, 1e-15);
    EXPECT_NEAR(clearance(Clearance::Mean), 24e-6, 1e-15);
    EXPECT_NEAR(clearance(Clearance::Max), 41e-6, 1e-15);
    // 20 H7/p6 is an interference fit: 1 to 35 µm too thick.
    const auto press = parseFit("H7/p6");
    ASSERT_TRUE(press);
    EXPECT_NEAR(*holeDiameter(*press, 0.02, Clearance::Max) - *shaftDiameter(*press, 0.02, Clearance::Max), -1e-6,
                1e-15);
    EXPECT_NEAR(*holeDiameter(*press, 0.02, Clearance::Min) - *shaftDiameter(*press, 0.02, Clearance::Min), -35e-6,
                1e-15);
}

TEST(IsoFit, RefusesWhatTheStandardDoesNotHave) {
    // Truth: closed form: one row per rule.
    for (const std::string text :
         {"",      "H7",    "g6/H7",  "H7/G6",  "h7/g6",   "H7g6",   "H7/",   "/g6",    "H7/g6/h6", "H7 /g6",
          "X7/g6", "H7/j6", "H19/g6", "H-1/g6", "H7.0/g6", "H07/g6", "JS/g6", "Js7/g6", "R7/g6",    "H7/g6 "})
        EXPECT_FALSE(parseFit(text)) << text;
    for (const std::string text : {"H7/g6", "JS9/js01", "H0/h18", "P9/s5"}) EXPECT_TRUE(parseFit(text)) << text;
    EXPECT_EQ(toString(parseFit("g6/H7").errors()[0]),
              "error: fit: must be a hole's and a shaft's tolerance class, such as \"H7/g6\"");
    EXPECT_EQ(keyOf("H7", 500.1), "nominal_diameter");
    EXPECT_EQ(keyOf("H7", 0.0), "nominal_diameter");
    EXPECT_EQ(keyOf("H7", -20.0), "nominal_diameter");
    EXPECT_EQ(keyOf("H7", std::numeric_limits<double>::quiet_NaN()), "nominal_diameter");
    EXPECT_EQ(keyOf("H14", 1.0), "nominal_diameter");
    EXPECT_EQ(keyOf("H13", 1.0), "");
    EXPECT_EQ(keyOf("N9", 1.0), "nominal_diameter");
    EXPECT_EQ(keyOf("K9", 20.0), "fit");
    EXPECT_EQ(keyOf("M2", 20.0), "fit");
    EXPECT_EQ(keyOf("Q7", 20.0), "fit");
}

}  // namespace
}  // namespace passung::shape
