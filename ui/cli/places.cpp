#include "ui/cli/places.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "study/run/files/stored_plans.h"
#include "study/session/plan_text.h"

namespace passung::cli {

namespace {

/// A person's place as the plan counts it; groups have names in the database.
session::DesignPlace placeOf(const plan::StudyPlan& plan, const store::ParticipantRow& person) {
    const auto groups = plan::groupNames(plan);
    const auto sequences = design::sequencesOf(plan::designOf(plan));
    const auto group = std::find(groups.begin(), groups.end(), person.group.value_or("")) - groups.begin();
    return {static_cast<std::size_t>(*person.replicate) * sequences + static_cast<std::size_t>(*person.sequence_index),
            static_cast<std::size_t>(group)};
}

}  // namespace

void printTakenPlaces(const store::StoreReader& reader) {
    const auto people = reader.participants();
    const auto protocols = reader.protocols();
    if (!people || !protocols) return;  // whoever reads next says why
    run::StoredPlans plans(reader, "");
    std::set<std::string> versions;
    for (const auto& protocol : *protocols) {
        std::map<std::string, std::vector<const store::ParticipantRow*>> by_kind;
        for (const auto& person : *people)
            if (person.place_sha256 == protocol.sha256) by_kind[person.kind].push_back(&person);
        if (!by_kind.empty()) versions.insert(protocol.version);
        for (const auto& [kind, placed] : by_kind) {
            const auto plan = plans.plan(protocol.sha256);
            if (!plan) {
                fmt::print("\nslots of version {}: their balance cannot be told: {}\n", protocol.version,
                           toString(plan.errors().front()));
                break;
            }
            std::vector<session::DesignPlace> places;
            for (const auto* person : placed) places.push_back(placeOf(**plan, *person));
            if (const auto text = session::describeBalance(**plan, places); !text.empty())
                fmt::print("\nslots of version {}, {}: {}", protocol.version, kind, text);
        }
    }
    if (versions.size() > 1)
        fmt::print("\nwarning: versions {} of the protocol count their slots apart: each is balanced by itself only\n",
                   fmt::join(versions, ", "));
}

}  // namespace passung::cli
