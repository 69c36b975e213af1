#include "ui/participant/part_instances.h"

namespace passung::participant {

PartInstances::PartInstances() {
    connect(this, &PartInstances::changed, this, [this] { markDirty(); });
}

void PartInstances::setPlacement(const QVariant& placement) {
    placement_ = placement.value<InstanceTable>();
    emit changed();
}

QVariantList PartInstances::colours() const {
    QVariantList all;
    for (const QColor& colour : colours_) all.append(colour);
    return all;
}

void PartInstances::setColours(const QVariantList& colours) {
    std::vector<QColor> all;
    for (const QVariant& colour : colours) all.push_back(colour.value<QColor>());
    if (all == colours_) return;
    colours_ = std::move(all);
    emit changed();
}

const std::vector<PartInstance>& PartInstances::placed() const {
    static const std::vector<PartInstance> kNone;
    if (!placement_) return kNone;
    const auto& all = images_ ? placement_->images : placement_->parts;
    const auto surface = static_cast<std::size_t>(surface_);
    return surface < all.size() ? all[surface] : kNone;
}

QByteArray PartInstances::getInstanceBuffer(int* count) {
    QByteArray table;
    table.reserve(static_cast<qsizetype>(placed().size()) * static_cast<qsizetype>(sizeof(InstanceTableEntry)));
    for (const PartInstance& one : placed()) {
        const auto place = static_cast<std::size_t>(flat_ ? one.part : one.look);
        const QColor colour = place < colours_.size() ? colours_[place] : QColor(Qt::white);
        const InstanceTableEntry entry =
            calculateTableEntryFromQuaternion(one.position, {1.0f, 1.0f, 1.0f}, one.rotation, colour);
        table.append(reinterpret_cast<const char*>(&entry), sizeof(entry));
    }
    *count = static_cast<int>(placed().size());
    return table;
}

}  // namespace passung::participant
