#include "study/protocol/trial_types.h"

#include <algorithm>
#include <array>

namespace passung::protocol {
namespace {

constexpr std::array<std::string_view, 4> kPegInHole{"search_time_s", "insertion_time_s", "insertion_depth_m",
                                                     "contact_time_outside_s"};
constexpr std::array<std::string_view, 5> kNarrowPassage{"passage_time_s", "passage_path_m", "passage_contact_time_s",
                                                         "passage_peak_force_N", "passage_entries"};
constexpr std::array<std::string_view, 5> kContourFollowing{
    "contour_progress", "contour_deviation_m", "contour_max_deviation_m", "contour_force_N", "contour_force_error_N"};
constexpr std::array<std::string_view, 2> kFreePlacement{"position_error_m", "angle_error_rad"};
constexpr std::array<std::string_view, 4> kDiscriminationPair{"comparison_interval", "answer", "correct",
                                                              "response_time_s"};

constexpr std::array<std::string_view, 7> kAssembly{"steps_done", "order_errors", "drops",     "regrasps",
                                                    "undos",      "hints",        "path_ratio"};

constexpr std::array kTypes{
    TrialType{"peg_in_hole", "task.peg_in_hole", kPegInHole},
    TrialType{"narrow_passage", "task.narrow_passage", kNarrowPassage},
    TrialType{"contour_following", "task.contour_following", kContourFollowing},
    TrialType{"free_placement", "task.free_placement", kFreePlacement},
    TrialType{"discrimination_pair", "task.discrimination_pair", kDiscriminationPair},
    TrialType{"assembly", "task.assembly", kAssembly},
};
static_assert(kTypes.size() == std::variant_size_v<decltype(plan::Task::form)>);

}  // namespace

std::span<const TrialType> trialTypes() { return kTypes; }

const TrialType& typeOf(const plan::Task& task) { return kTypes[task.form.index()]; }

std::vector<const TrialType*> typesWith(std::string_view measure) {
    std::vector<const TrialType*> types;
    for (const TrialType& type : kTypes)
        if (std::find(type.measures.begin(), type.measures.end(), measure) != type.measures.end())
            types.push_back(&type);
    return types;
}

std::vector<std::string> measuresOf(std::span<const TrialType* const> types, std::span<const std::string> known) {
    std::vector<std::string> names;
    for (const std::string& name : known) {
        const auto of = typesWith(name);
        const bool had = of.empty() || std::any_of(of.begin(), of.end(), [&](const TrialType* type) {
                             return std::find(types.begin(), types.end(), type) != types.end();
                         });
        if (had) names.push_back(name);
    }
    return names;
}

}  // namespace passung::protocol
