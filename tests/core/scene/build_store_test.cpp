#include "core/scene/build_store.h"

#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/field/distance_field.h"
#include "core/scene/part.h"
#include "core/shell/shell_bytes.h"

namespace passung::scene {
namespace {

/// In memory; counts, and lets a test look at and spoil what it holds.
struct MemoryStore : BuildStore {
    std::map<std::string, std::string> files;
    int found = 0, kept = 0;
    std::optional<std::string> load(const std::string& name) override {
        const auto file = files.find(name);
        if (file == files.end()) return std::nullopt;
        ++found;
        return file->second;
    }
    void keep(const std::string& name, std::string_view bytes) override {
        ++kept;
        files[name] = bytes;
    }
};

const PartNeeds kNeeds{.field = true, .shell = true, .tolerance = 50e-6, .spacing = 2e-3};

Part build(const shape::Shape& shape, BuildStore* store, const PartNeeds& needs = kNeeds) {
    PartSpec spec;
    spec.name = "part";
    spec.geometry = shape;
    auto part = buildPart(spec, needs, store);
    EXPECT_TRUE(part);
    return std::move(*part);
}

bool tellsDamage(const Part& part) {
    for (const std::string& note : part.report.notes)
        if (note.find("damaged or foreign: built anew") != std::string::npos) return true;
    return false;
}

bool sameBits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

void expectSameBits(const Part& a, const Part& b) {
    EXPECT_EQ(a.field->toBytes(), b.field->toBytes());
    Random random(1);
    const geometry::Bounds bounds = a.field->bounds();
    for (int i = 0; i < 3000; ++i) {
        Vec3 p;
        for (int k = 0; k < 3; ++k) p[k] = random.uniform(bounds.low[k] - 0.003, bounds.high[k] + 0.003);
        for (const field::FieldMode mode : field::kFieldModes) {
            ASSERT_TRUE(sameBits(a.field->sample(p, mode).phi, b.field->sample(p, mode).phi));
            ASSERT_TRUE(sameBits(a.field->errorBound(p, mode), b.field->errorBound(p, mode)));
        }
        ASSERT_TRUE(sameBits(a.field->lowerBound(p), b.field->lowerBound(p)));
    }
    ASSERT_EQ(a.shell->nodes().size(), b.shell->nodes().size());
    ASSERT_EQ(a.shell->points().size(), b.shell->points().size());
    for (std::size_t i = 0; i < a.shell->points().size(); ++i) {
        const shell::SurfacePoint &p = a.shell->points()[i], &q = b.shell->points()[i];
        ASSERT_TRUE(p.position == q.position && p.normal == q.normal && sameBits(p.area, q.area));
    }
    for (std::size_t i = 0; i < a.shell->nodes().size(); ++i)
        ASSERT_TRUE(sameBits(a.shell->nodes()[i].radius, b.shell->nodes()[i].radius));
}

TEST(BuildStore, WhatComesBackHasTheBitsOfWhatWasBuilt) {
    // Truth: invariant. A refined solid and an open sheet.
    for (const shape::Shape& shape : {shape::Shape(shape::BorePlate{0.02, 0.02, 0.008, 0.01, 0.006, 0.0}),
                                      shape::Shape(shape::Sheet{0.02, 0.01})}) {
        MemoryStore store;
        const Part built = build(shape, nullptr), kept = build(shape, &store);
        EXPECT_EQ(store.kept, 2);
        EXPECT_EQ(store.found, 0);
        const Part loaded = build(shape, &store);
        EXPECT_EQ(store.kept, 2);
        EXPECT_EQ(store.found, 2);
        expectSameBits(built, kept);
        expectSameBits(built, loaded);
        EXPECT_EQ(loaded.report.notes, built.report.notes);
        EXPECT_FALSE(tellsDamage(loaded));
    }
}

TEST(BuildStore, OtherGeometryAndOtherNeedsAreOtherBuilds) {
    // Truth: invariant.
    MemoryStore store;
    build(shape::Sphere{0.01}, &store);
    build(shape::Sphere{0.0100000001}, &store);
    EXPECT_EQ(store.kept, 4);
    PartNeeds finer = kNeeds;
    finer.tolerance = 40e-6;
    build(shape::Sphere{0.01}, &store, finer);
    PartNeeds even = kNeeds;
    even.cell = 1e-3;
    build(shape::Sphere{0.01}, &store, even);
    PartNeeds deeper = kNeeds;
    deeper.depth = 1e-3;
    build(shape::Sphere{0.01}, &store, deeper);
    PartNeeds closer = kNeeds;
    closer.spacing = 1e-3;
    build(shape::Sphere{0.01}, &store, closer);
    EXPECT_EQ(store.files.size(), static_cast<std::size_t>(store.kept));
    EXPECT_GE(store.kept, 4 + 4);
}

TEST(BuildStore, NeverTakesATornOrSpoiledFileAndMendsIt) {
    // Truth: invariant. A file cut at any of many places, with any of many bits turned, or with more at its end.
    const shape::Sphere ball{0.01};
    MemoryStore store;
    const Part sound = build(ball, &store);
    const auto files = store.files;
    std::vector<std::pair<std::string, std::string>> spoiled;
    Random random(2);
    for (const auto& [name, bytes] : files) {
        for (int i = 0; i < 12; ++i) spoiled.emplace_back(name, bytes.substr(0, random.below(bytes.size())));
        for (const std::size_t at : {std::size_t{3}, std::size_t{20}, bytes.size() / 2, bytes.size() - 9,
                                     bytes.size() - 1, static_cast<std::size_t>(random.below(bytes.size()))}) {
            std::string turned = bytes;
            turned[at] = static_cast<char>(turned[at] ^ (1 << random.below(8)));
            spoiled.emplace_back(name, turned);
        }
        spoiled.emplace_back(name, bytes + '\0');
        spoiled.emplace_back(name, std::string());
        spoiled.emplace_back(name, std::string(bytes.size(), '\0'));
    }
    for (const auto& [name, bytes] : spoiled) {
        store.files = files;
        store.files[name] = bytes;
        const Part part = build(ball, &store);
        EXPECT_TRUE(tellsDamage(part));
        EXPECT_EQ(part.field->toBytes(), sound.field->toBytes());
        EXPECT_EQ(store.files, files);
    }
}

TEST(BuildStore, NeverTakesAFileOfAnotherKey) {
    // Truth: invariant. Two sound files in each other's place: their keys say so.
    MemoryStore store;
    const Part sound = build(shape::Sphere{0.01}, &store);
    const auto first = store.files.begin(), second = std::next(first);
    std::swap(first->second, second->second);
    const Part part = build(shape::Sphere{0.01}, &store);
    EXPECT_TRUE(tellsDamage(part));
    EXPECT_EQ(part.field->toBytes(), sound.field->toBytes());
    EXPECT_FALSE(unsealed("another", sealed("key", "content")));
    EXPECT_FALSE(unsealed("kez", sealed("key", "content")));
    EXPECT_EQ(unsealed("key", sealed("key", "content")).value_or(""), "content");
}

TEST(BuildStore, EveryBitOfASmallFileCounts) {
    // Truth: invariant (a checksum and lengths over all: no single bit may turn unseen).
    const std::string bytes = sealed("key", "content of thirty-one bytes....");
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        std::string turned = bytes;
        turned[bit / 8] = static_cast<char>(turned[bit / 8] ^ (1 << bit % 8));
        EXPECT_FALSE(unsealed("key", turned)) << bit;
    }
}

TEST(BuildStore, BytesThatHoldNoFieldAreRefused) {
    // Truth: invariant. Behind a right checksum, too: a brick that is its own child would never end a query.
    const Part part = build(shape::Sphere{0.01}, nullptr);
    const std::string bytes = part.field->toBytes();
    EXPECT_TRUE(field::DistanceField::fromBytes(bytes));
    EXPECT_FALSE(field::DistanceField::fromBytes(bytes.substr(0, bytes.size() - 1)));
    EXPECT_FALSE(field::DistanceField::fromBytes(bytes + '\0'));
    EXPECT_FALSE(field::DistanceField::fromBytes(""));
    Random random(3);
    int refused = 0;
    for (int i = 0; i < 400; ++i) {
        std::string turned = bytes;
        const std::size_t at = random.below(200);  // the head: bounds, counts, cells
        turned[at] = static_cast<char>(turned[at] ^ 0x40);
        const auto field = field::DistanceField::fromBytes(turned);
        refused += field ? 0 : 1;
        EXPECT_TRUE(!field || field->brickCount() > 0);
    }
    EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace passung::scene
