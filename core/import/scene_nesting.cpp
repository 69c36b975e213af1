#include <algorithm>
#include <cstdint>

#include "core/import/scene_file_limits.h"

namespace passung::importer {

namespace {

/// What an object with all that stands in it comes to.
struct Sum {
    enum class State : std::uint8_t { New, Open, Done } state = State::New;
    double instances = 1.0, corners = 0.0;
    int depth = 1;
    std::size_t taken = 0;  // inner objects that are counted already
};

}  // namespace

std::size_t Nesting::number(const std::string& name) {
    const auto [place, fresh] = numbers_.try_emplace(name, objects_.size());
    if (fresh) objects_.emplace_back();
    return place->second;
}

std::optional<std::string> Nesting::tooMuch(std::size_t object) const {
    using Limits = SceneFileLimits;
    std::vector<Sum> sums(objects_.size());
    std::vector<std::size_t> open{object};
    sums[object].state = Sum::State::Open;
    sums[object].corners = objects_[object].corners;
    while (!open.empty()) {
        const std::size_t outer = open.back();
        Sum& sum = sums[outer];
        if (sum.taken == objects_[outer].inner.size()) {
            sum.state = Sum::State::Done;
            open.pop_back();
            continue;
        }
        const std::size_t inner = objects_[outer].inner[sum.taken];
        Sum& part = sums[inner];
        if (part.state == Sum::State::Open) return "an object must not contain itself";
        if (part.state == Sum::State::New) {
            part.state = Sum::State::Open;
            part.corners = objects_[inner].corners;
            open.push_back(inner);
            if (open.size() > static_cast<std::size_t>(Limits::kMostNesting))
                return "objects must stand in one another at most " + std::to_string(Limits::kMostNesting) + " deep";
            continue;
        }
        ++sum.taken;
        sum.instances += part.instances;
        sum.corners += part.corners;
        sum.depth = std::max(sum.depth, part.depth + 1);
        if (sum.instances > Limits::kMostInstances) return "it must hold at most 100000 objects, each time counted";
        if (sum.corners > Limits::kMostCorners) return "it must hold at most 50000000 triangles, each time counted";
        if (sum.depth > Limits::kMostNesting)
            return "objects must stand in one another at most " + std::to_string(Limits::kMostNesting) + " deep";
    }
    if (sums[object].corners > Limits::kMostCorners)
        return "it must hold at most 50000000 triangles, each time counted";
    return std::nullopt;
}

}  // namespace passung::importer
