#include "core/contact/certificates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include "core/base/random.h"
#include "core/contact/contact_query.h"
#include "core/contact/edge_search.h"
#include "core/field/distance_field.h"
#include "core/scene/part.h"

namespace passung {
namespace {

constexpr double kTolerance = 5e-6;

scene::Part build(const shape::Shape& shape) {
    scene::PartSpec spec;
    spec.geometry = shape;
    auto part = scene::buildPart(spec, {.field = true, .shell = true, .tolerance = kTolerance, .spacing = 1e-3});
    EXPECT_TRUE(part);
    return std::move(*part);
}

/// A peg of 20 mm that wanders in a bore with 0.1 mm of radial clearance, now slowly, now by more than the clearance a
/// look; now and then it is put elsewhere.
class Wander {
public:
    Pose next() {
        const double scale = std::pow(10.0, random_.uniform(-7.0, -3.5));  // [m] a look
        if (look_++ % 300 == 0) X_ = {Quat::Identity(), Vec3(0, 0, random_.uniform(-0.02, 0.002))};
        X_.q = (rotationFromVector(scale / 0.02 * vector()) * X_.q).normalized();
        X_.p += scale * vector() - 0.05 * Vec3(X_.p.x(), X_.p.y(), 0.0);
        return X_;
    }

private:
    Vec3 vector() { return {random_.normal(), random_.normal(), random_.normal()}; }
    Random random_{7};
    Pose X_;
    int look_ = 0;
};

/// Of points or of edges.
struct Look {
    contact::QueryAnswer answer;
    contact::ContactManifold manifold;
};

void expectSame(const Look& with, const Look& without) {
    EXPECT_EQ(with.answer.found, without.answer.found);
    EXPECT_EQ(with.answer.phi, without.answer.phi);
    EXPECT_EQ(with.answer.contacts, without.answer.contacts);
    ASSERT_EQ(with.manifold.size(), without.manifold.size());
    for (std::size_t i = 0; i < with.manifold.size(); ++i) {
        const contact::ContactPoint &a = with.manifold[i], &b = without.manifold[i];
        EXPECT_TRUE(a.position == b.position && a.gradient == b.gradient && a.normal == b.normal && a.phi == b.phi);
    }
}

/// What a tick asks for: contacts and the nearest point; whether anything is deeper; how deep the deepest is.
contact::QueryRequest requestOf(int i) {
    if (i % 3 == 0) return {.collect_below = 40e-6, .every_below = 2e-6, .search_below = 100e-6, .facing = true};
    if (i % 3 == 1) return {.collect_below = -1e300, .search_below = -2e-6};
    return {.collect_below = -1e300};
}

TEST(Certificates, LeaveWhatALookFindsAndSpareMostOfItsReadings) {
    // Truth: invariant, bit for bit; without certificates contact_query_test.cpp tests the same against every point.
    const scene::Part plate = build(shape::BorePlate{0.03, 0.03, 0.02, 0.0202, 0.02, 0.001});
    const scene::Part peg = build(shape::Peg{0.02, 0.024, 0.001});
    contact::QueryWorkspace workspace(peg.shell->nodes().size());
    const std::size_t most = peg.shell->points().size() + peg.edges->stations().size();
    contact::Certificates nodes(peg.shell->nodes().size(), kTolerance);
    contact::Certificates stretches(peg.edges->stretches().size(), kTolerance);
    const Pose X_WF{rotationFromVector(Vec3(0.3, -0.2, 0.5)), Vec3(0.01, 0.02, 0.03)};
    Wander wander;
    std::size_t read = 0, read_without = 0, visited = 0, visited_without = 0, contacts = 0;
    for (int i = 0; i < 3000; ++i) {
        const Pose X_WS = X_WF * wander.next();
        const contact::QueryRequest request = requestOf(i);
        const auto look = [&](bool with) {
            Look found{{}, contact::ContactManifold(most)};
            found.answer = contact::queryContacts(*plate.field, X_WF, *peg.shell, X_WS, request, workspace,
                                                  found.manifold, with ? &nodes : nullptr);
            return found;
        };
        const auto along = [&](bool with) {
            Look found{{}, contact::ContactManifold(most)};
            found.answer = contact::searchEdges(*plate.field, X_WF, *peg.edges, X_WS, request, found.manifold,
                                                with ? &stretches : nullptr);
            return found;
        };
        const Look with = look(true), without = look(false);
        expectSame(with, without);
        expectSame(along(true), along(false));
        if (HasFailure()) break;
        read += static_cast<std::size_t>(with.answer.points_tested);
        read_without += static_cast<std::size_t>(without.answer.points_tested);
        visited += static_cast<std::size_t>(with.answer.nodes_visited);
        visited_without += static_cast<std::size_t>(without.answer.nodes_visited);
        contacts += with.manifold.size();
    }
    EXPECT_GT(contacts, 1000u);
    RecordProperty("points_read", static_cast<int>(read));
    RecordProperty("points_read_without", static_cast<int>(read_without));
    EXPECT_LT(read, read_without / 2);
    EXPECT_LT(visited, visited_without * 6 / 10);
}

/// The same in cells of one size, of which is known how what is read of them changes.
TEST(Certificates, SpareLeavesOfUniformCellsAndNothingElse) {
    // Truth: invariant, bit for bit, nodes that are visited included.
    const auto uniform = [](const shape::Shape& shape) {
        scene::PartSpec spec;
        spec.geometry = shape;
        auto part = scene::buildPart(spec, {.field = true, .shell = true, .cell = 0.5e-3, .spacing = 1e-3});
        EXPECT_TRUE(part);
        return std::move(*part);
    };
    const scene::Part plate = uniform(shape::BorePlate{0.06, 0.06, 0.03, 0.0205, 0.025, 0.5e-3});
    const scene::Part peg = uniform(shape::Peg{0.02, 0.05, 0.5e-3});
    ASSERT_GT(plate.field->change().within, 0.5e-3);
    contact::QueryWorkspace workspace(peg.shell->nodes().size());
    const Pose X_WF{rotationFromVector(Vec3(0.3, -0.2, 0.5)), Vec3(0.01, 0.02, 0.03)};
    // As the penalty asks, and as god objects do.
    const std::array<contact::QueryRequest, 3> requests{
        {{.gradients = false, .every_node = true, .refine = true},
         {.collect_below = 40e-6, .every_below = 2e-6, .search_below = 100e-6, .facing = true},
         {.collect_below = -1e300}}};
    for (const contact::QueryRequest& request : requests) {
        // Certificates of nodes are made without what is known of the cells, so that they are the same in both.
        contact::Certificates with_change(peg.shell->nodes().size(), 0.5e-3, plate.field->change());
        contact::Certificates without_change(peg.shell->nodes().size(), 0.5e-3);
        Wander wander;
        std::size_t read = 0, read_without = 0, spared = 0, contacts = 0;
        for (int i = 0; i < 3000; ++i) {
            const Pose X_WS = X_WF * wander.next();
            const auto look = [&](contact::Certificates& known) {
                Look found{{}, contact::ContactManifold(peg.shell->points().size())};
                found.answer = contact::queryContacts(*plate.field, X_WF, *peg.shell, X_WS, request, workspace,
                                                      found.manifold, &known);
                return found;
            };
            const Look with = look(with_change), without = look(without_change);
            expectSame(with, without);
            EXPECT_EQ(with.answer.nodes_visited, without.answer.nodes_visited);
            EXPECT_EQ(with.answer.points_tested + with.answer.points_spared, without.answer.points_tested);
            if (HasFailure()) return;
            read += static_cast<std::size_t>(with.answer.points_tested);
            read_without += static_cast<std::size_t>(without.answer.points_tested);
            spared += static_cast<std::size_t>(with.answer.points_spared);
            contacts += static_cast<std::size_t>(with.answer.contacts);
        }
        EXPECT_GT(spared, read_without / 10) << read;
        EXPECT_GT(contacts + spared, 1000u);
    }
}

TEST(Certificates, HoldForEveryPointOfASphereThatMoves) {
    // Truth: closed form, φ = z. What is passed is above the limit, by every corner of a cube in the sphere; and at the
    // pose of the proof nothing is lost.
    constexpr double kRadius = 2e-3;
    const Vec3 centre(0.01, -0.005, 0.02);
    contact::Certificates certificates(1, 0.0);
    Random random(3);
    Pose X;
    int passed = 0, asked = 0;
    for (int look = 0; look < 5000; ++look) {
        const double scale = std::pow(10.0, random.uniform(-6.0, -3.0));
        const auto vector = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
        X = {(rotationFromVector(20.0 * scale * vector()) * X.q).normalized(), X.p + scale * vector()};
        certificates.begin(X);
        const double lowest = (X * centre).z() - kRadius;
        const double limit = lowest - std::pow(10.0, random.uniform(-6.0, -2.5)), asked_for = limit / 1.1 - 1e-12;
        ++asked;
        if (certificates.above(0, centre, kRadius, asked_for)) {
            ++passed;
            for (int corner = 0; corner < 8; ++corner) {
                const Vec3 aside((corner & 1) ? 1 : -1, (corner & 2) ? 1 : -1, (corner & 4) ? 1 : -1);
                EXPECT_GE((X * (centre + kRadius / std::sqrt(3.0) * aside)).z(), asked_for);
            }
            EXPECT_GE(lowest, asked_for);
        }
        if (look % 20 == 0) {
            certificates.note(0, lowest);
            EXPECT_TRUE(certificates.above(0, centre, kRadius, lowest - 0.2 * std::abs(lowest) - 1e-9));
        }
    }
    EXPECT_GT(passed, asked / 20);
    EXPECT_LT(passed, asked);
}

TEST(Certificates, KnowNothingWithoutMemoryOrOfLooksLongAgo) {
    // Truth: the contract in the header.
    contact::Certificates none, some(1, 0.0);
    none.begin({});
    none.note(0, 1.0);
    EXPECT_FALSE(none.above(0, Vec3::Zero(), 1e-3, 0.0));
    some.begin({});
    EXPECT_FALSE(some.above(0, Vec3::Zero(), 1e-3, 0.0));
    some.note(0, 1.0);
    EXPECT_TRUE(some.above(0, Vec3::Zero(), 1e-3, 0.0));
    for (std::uint32_t i = 1; i <= contact::Certificates::kPoses; ++i)
        some.begin({Quat::Identity(), Vec3(1e-6 * i, 0, 0)});
    EXPECT_FALSE(some.above(0, Vec3::Zero(), 1e-3, 0.0));
}

TEST(PausedLook, FindsInSeveralCallsWhatOneFindsInOne) {
    // Truth: invariant, bit for bit but for the order of contacts: of points and of edges, with certificates and
    // without, by budgets down to one node.
    const scene::Part plate = build(shape::BorePlate{0.03, 0.03, 0.02, 0.0202, 0.02, 0.001});
    const scene::Part peg = build(shape::Peg{0.02, 0.024, 0.001});
    contact::QueryWorkspace whole_space(peg.shell->nodes().size()), workspace(peg.shell->nodes().size());
    const std::size_t most = peg.shell->points().size() + peg.edges->stations().size();
    contact::Certificates nodes(peg.shell->nodes().size(), kTolerance);
    contact::Certificates stretches(peg.edges->stretches().size(), kTolerance);
    const auto sorted = [](const contact::ContactManifold& manifold) {
        std::vector<contact::ContactPoint> all(manifold.begin(), manifold.end());
        std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
            return std::lexicographical_compare(a.position.data(), a.position.data() + 3, b.position.data(),
                                                b.position.data() + 3);
        });
        return all;
    };
    Wander wander;
    int calls = 0, contacts = 0;
    for (int i = 0; i < 400; ++i) {
        const Pose X_WS = wander.next();
        contact::QueryRequest request{.collect_below = 40e-6, .search_below = i % 2 == 0 ? 100e-6 : 40e-6};
        Look whole{{}, contact::ContactManifold(most)}, paused{{}, contact::ContactManifold(most)};
        whole.answer =
            contact::queryContacts(*plate.field, Pose{}, *peg.shell, X_WS, request, whole_space, whole.manifold);
        const contact::QueryAnswer edges =
            contact::searchEdges(*plate.field, Pose{}, *peg.edges, X_WS, request, whole.manifold);
        request.max_nodes = std::array{1, 7, 60, 500}[static_cast<std::size_t>(i) % 4];
        request.pauses = true;
        const bool known = i % 8 < 4;
        do {
            paused.answer = contact::queryContacts(*plate.field, Pose{}, *peg.shell, X_WS, request, workspace,
                                                   paused.manifold, known ? &nodes : nullptr);
            EXPECT_LE(paused.answer.nodes_visited, request.max_nodes + 8);
            ++calls;
        } while (paused.answer.paused);
        contact::EdgePause pause;
        contact::QueryAnswer paused_edges;
        do {
            paused_edges = contact::searchEdges(*plate.field, Pose{}, *peg.edges, X_WS, request, paused.manifold,
                                                known ? &stretches : nullptr, &pause);
            EXPECT_LE(paused_edges.nodes_visited, request.max_nodes);
        } while (paused_edges.paused);
        ASSERT_EQ(paused.answer.phi, whole.answer.phi) << i;
        ASSERT_EQ(paused.answer.found, whole.answer.found) << i;
        ASSERT_EQ(paused_edges.phi, edges.phi) << i;
        const auto a = sorted(paused.manifold), b = sorted(whole.manifold);
        ASSERT_EQ(a.size(), b.size()) << i;
        for (std::size_t k = 0; k < a.size(); ++k)
            ASSERT_TRUE(a[k].position == b[k].position && a[k].gradient == b[k].gradient && a[k].phi == b[k].phi) << i;
        contacts += static_cast<int>(a.size());
    }
    EXPECT_GT(calls, 4000);
    EXPECT_GT(contacts, 4000);
}

}  // namespace
}  // namespace passung
