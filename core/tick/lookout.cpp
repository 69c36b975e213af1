#include "core/tick/lookout.h"

#include <algorithm>

#include "core/field/distance_field.h"
#include "core/shell/edge_curves.h"

namespace passung::tick {

namespace {

/// Of a field near its surface [m]. Cells of a size that was chosen take no tolerance.
double accuracyOf(const HandModel& model, const field::DistanceField& field) noexcept {
    return std::max(model.contact.tolerance, model.contact.cell > 0.0 ? field.cell() : 0.0);
}

contact::ShellCertificates room(std::size_t nodes, std::size_t stretches) {
    return {contact::Certificates(nodes, 0.0), contact::Certificates(stretches, 0.0)};
}

void restart(contact::ShellCertificates& known, double accuracy, const field::DistanceField& field) noexcept {
    known.nodes.restart(accuracy, field.change());
    known.stretches.restart(accuracy);
}

}  // namespace

KnownPairs::KnownPairs(const HandModel& model)
    : slots_(std::min(model.obstacles.size(), kMost)),
      slot_of_(model.obstacles.size(), static_cast<std::uint8_t>(kMost)) {
    std::size_t nodes = 0, stretches = 0;  // of any obstacle
    for (const Obstacle& obstacle : model.obstacles) {
        if (obstacle.shell == nullptr) continue;
        nodes = std::max(nodes, obstacle.shell->nodes().size());
        stretches = std::max(stretches, obstacle.edges->stretches().size());
    }
    for (Slot& slot : slots_)
        slot.pair = {room(model.shell->nodes().size(), model.edges->stretches().size()), room(nodes, stretches)};
}

PairCertificates* KnownPairs::of(const HandModel& model, std::uint32_t i) noexcept {
    if (slots_.empty()) return nullptr;
    if (slot_of_[i] == kMost) {
        const auto oldest = std::min_element(slots_.begin(), slots_.end(),
                                             [](const Slot& a, const Slot& b) { return a.look < b.look; });
        if (oldest->look + 1 >= look_) return nullptr;
        if (oldest->obstacle != kNobody) slot_of_[oldest->obstacle] = kMost;
        slot_of_[i] = static_cast<std::uint8_t>(oldest - slots_.begin());
        oldest->obstacle = i;
        const field::DistanceField& field = *model.obstacles[i].field;
        restart(oldest->pair.held, accuracyOf(model, field), field);
        if (model.held_field != nullptr)
            restart(oldest->pair.obstacle, accuracyOf(model, *model.held_field), *model.held_field);
    }
    Slot& slot = slots_[slot_of_[i]];
    slot.look = look_;
    return &slot.pair;
}

Lookout lookoutOf(const HandModel& model) {
    double accuracy = model.contact.tolerance;
    for (const Obstacle& obstacle : model.obstacles) accuracy = std::max(accuracy, obstacle.field->cell());
    if (model.held_field != nullptr)
        accuracy = std::max(accuracy, model.held_field->cell() + model.held_field->sheetOffset());
    return {nearListOf(model, 2.0 * accuracy), {}};
}

}  // namespace passung::tick
