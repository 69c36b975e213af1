#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/bytes.h"
#include "core/field/distance_field.h"

namespace passung::field {

namespace {

constexpr int kFewestCoarseCells = 3;      // per axis, that every mode of interpolation can do with
constexpr int kMostCoarseCells = 1 << 12;  // per axis; build() makes a few hundred

}  // namespace

std::string DistanceField::toBytes() const {
    ByteWriter writer;
    for (const Vec3& v : {surface_bounds_.low, surface_bounds_.high, origin_}) writer.put(v);
    for (const int cells : coarse_cells_) writer.put(static_cast<std::uint64_t>(cells), 4);
    for (const double value : {cell_, largest_cell_, finest_cell_, brick_edge_, inverse_brick_edge_, sheet_offset_,
                               arithmetic_, bounded_within_})
        writer.put(value);
    writer.put((bound_proven_ ? 1u : 0u) + (refined_ ? 2u : 0u), 1);
    writer.put(coarse_.size(), 8);
    for (const float value : coarse_) writer.put(std::bit_cast<std::uint32_t>(value), 4);
    for (const std::int32_t brick : brick_of_cell_) writer.put(static_cast<std::uint32_t>(brick), 4);
    writer.put(bricks_.size(), 8);
    for (std::size_t k = 0; k < bricks_.size(); ++k) {
        const Brick& brick = bricks_[k];
        writer.put(brick.low);
        writer.put(brick.step);
        for (const std::int32_t child : brick.child) writer.put(static_cast<std::uint32_t>(child), 4);
        for (const std::uint8_t slack : slacks_[k]) writer.put(slack, 1);
        writer.put(static_cast<std::uint32_t>(brick.level), 4);
    }
    for (const std::uint16_t sample : samples_) writer.put(sample, 2);
    return writer.take();
}

/// Each brick has one parent at most, which stands a level above it, or is one cell's root: the ways down end.
bool DistanceField::soundBricks() const {
    std::vector<char> used(bricks_.size(), 0);
    const auto use = [&](std::int32_t id, int level) {
        if (id == -1) return true;
        if (id < 0 || static_cast<std::size_t>(id) >= bricks_.size()) return false;
        const auto i = static_cast<std::size_t>(id);
        const bool first = used[i] == 0;
        used[i] = 1;
        return first && bricks_[i].level == level;
    };
    bool some_root = false;
    for (const std::int32_t root : brick_of_cell_) {
        if (!use(root, 0)) return false;
        some_root = some_root || root >= 0;
    }
    if (!some_root) return false;
    for (const Brick& brick : bricks_) {
        if (brick.level < 0 || brick.level > kMostLevels || !std::isfinite(brick.low) || !std::isfinite(brick.step))
            return false;
        for (const std::int32_t child : brick.child)
            if (!use(child, brick.level + 1)) return false;
    }
    return true;
}

bool DistanceField::soundGrid() const {
    const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
    for (const double value : {cell_, largest_cell_, finest_cell_, brick_edge_, inverse_brick_edge_})
        if (!positive(value)) return false;
    for (const double value : {sheet_offset_, arithmetic_})
        if (!(value >= 0.0) || !std::isfinite(value)) return false;
    if (!std::isfinite(bounded_within_)) return false;
    for (const Vec3& v : {surface_bounds_.low, surface_bounds_.high, origin_})
        if (!v.allFinite()) return false;
    if (brick_edge_ != kBrickCells * largest_cell_ || inverse_brick_edge_ != 1.0 / brick_edge_) return false;
    return std::all_of(coarse_cells_.begin(), coarse_cells_.end(),
                       [](int cells) { return cells >= kFewestCoarseCells && cells <= kMostCoarseCells; });
}

std::optional<DistanceField> DistanceField::fromBytes(std::string_view bytes) {
    ByteReader reader(bytes);
    DistanceField field;
    for (Vec3* v : {&field.surface_bounds_.low, &field.surface_bounds_.high, &field.origin_}) *v = reader.takeVec3();
    for (int& cells : field.coarse_cells_) cells = static_cast<int>(static_cast<std::uint32_t>(reader.take(4)));
    for (double* value : {&field.cell_, &field.largest_cell_, &field.finest_cell_, &field.brick_edge_,
                          &field.inverse_brick_edge_, &field.sheet_offset_, &field.arithmetic_, &field.bounded_within_})
        *value = reader.takeDouble();
    const std::uint64_t flags = reader.take(1);
    field.bound_proven_ = (flags & 1u) != 0;
    field.refined_ = (flags & 2u) != 0;
    if (reader.failed() || flags > 3 || !field.soundGrid()) return std::nullopt;
    std::size_t nodes = 1, cells = 1;
    for (const int n : field.coarse_cells_) {
        nodes *= static_cast<std::size_t>(n) + 1;
        cells *= static_cast<std::size_t>(n);
    }
    field.coarse_.resize(reader.takeCount(4));
    if (field.coarse_.size() != nodes) return std::nullopt;
    bool finite = true;
    for (float& value : field.coarse_) {
        value = std::bit_cast<float>(static_cast<std::uint32_t>(reader.take(4)));
        finite = finite && std::isfinite(value);
    }
    field.brick_of_cell_.resize(cells);
    for (std::int32_t& brick : field.brick_of_cell_) brick = static_cast<std::int32_t>(reader.take(4));
    field.bricks_.resize(reader.takeCount(60 + 2 * kBrickSamples));
    field.slacks_.resize(field.bricks_.size());
    for (std::size_t k = 0; k < field.bricks_.size(); ++k) {
        Brick& brick = field.bricks_[k];
        brick.low = reader.takeDouble();
        brick.step = reader.takeDouble();
        for (std::int32_t& child : brick.child) child = static_cast<std::int32_t>(reader.take(4));
        for (std::uint8_t& slack : field.slacks_[k]) slack = static_cast<std::uint8_t>(reader.take(1));
        brick.level = static_cast<std::int32_t>(reader.take(4));
        brick.refined = std::any_of(brick.child.begin(), brick.child.end(), [](std::int32_t c) { return c >= 0; });
    }
    if (reader.failed() || !finite || !field.soundBricks()) return std::nullopt;
    field.samples_.resize(field.bricks_.size() * kBrickSamples);
    for (std::uint16_t& sample : field.samples_) sample = static_cast<std::uint16_t>(reader.take(2));
    if (!reader.atEnd()) return std::nullopt;
    field.fillIndex();
    field.measureChange();
    return field;
}

}  // namespace passung::field
