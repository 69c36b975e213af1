#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/query/part_query.h"
#include "tests/support/mesh_pairs.h"

namespace passung {
namespace {

using truth::Relation;

// The median bound is then a good third of a millimetre, on parts of 10 to 30 mm.
constexpr double kCell = 0.15e-3, kSpacing = 0.25e-3;
constexpr double kDepthResolution = 50e-6;  // to which the true depth is known; enters every comparison
constexpr double kSpread = 2e-3;            // of the poses near first contact
constexpr int kPoses = 700;                 // a pair

test::MeshPair pairOf(const char* name, const geometry::TriangleMesh& field, const geometry::TriangleMesh& shell) {
    return {name, test::meshPart(field, "fcl_field", kCell, kSpacing),
            test::meshPart(shell, "fcl_shell", kCell, kSpacing)};
}

struct Counts {
    int of[4] = {0, 0, 0, 0};
    int undecided = 0;  // the bound leaves open whether the surface reaches in
    std::vector<double> bounds;
    int operator[](Relation r) const { return of[static_cast<int>(r)]; }
};

/// Half of the poses near first contact, a fourth anywhere, a fourth about the middle of the field's part.
Counts compare(test::MeshPair& pair, Random& random) {
    query::PartQuery query(pair.field, pair.shell, {});
    Counts counts;
    for (int i = 0; i < kPoses; ++i) {
        Pose X_FS = i % 2 == 0 ? test::poseNearContact(pair, kSpread, random) : test::poseAnywhere(pair, random);
        if (i % 4 == 1) X_FS.p *= 0.2;
        const auto r = query.at(X_FS);
        const test::PairTruth truth = test::truthOf(pair, X_FS, kDepthResolution);
        const auto place = [&] {
            ::testing::Message m;
            m << pair.name << " pose " << i << ": " << test::toText(X_FS) << "\n  distance " << r.signed_distance
              << " ± " << r.error_bound << ", in [" << r.lower_bound << ", " << r.upper_bound << "]; truth in ["
              << truth.shell_in_field.low << ", " << truth.shell_in_field.high << "], FCL says "
              << truth::toString(truth.relation);
            return m;
        };
        const test::TrueInterval& m = truth.shell_in_field;
        const double true_uncertainty = m.high - m.low;
        EXPECT_LE(true_uncertainty, kDepthResolution) << place();
        EXPECT_LE(std::abs(r.signed_distance - m.high), r.error_bound + true_uncertainty) << place();
        EXPECT_LE(r.lower_bound, m.high) << place();
        EXPECT_GE(r.upper_bound, m.low) << place();
        ++counts.of[static_cast<int>(truth.relation)];
        counts.undecided += r.lower_bound <= 0.0 && r.upper_bound >= 0.0 ? 1 : 0;
        counts.bounds.push_back(r.error_bound);
        if (::testing::Test::HasFailure()) break;  // one pose is enough to look into
    }
    std::sort(counts.bounds.begin(), counts.bounds.end());
    std::printf(
        "%-30s apart %d, surfaces intersect %d, B inside A %d, A inside B %d; undecided %d of %d; bound median %.2f "
        "mm, "
        "90 %% %.2f mm\n",
        pair.name.c_str(), counts[Relation::Apart], counts[Relation::SurfacesIntersect], counts[Relation::BInsideA],
        counts[Relation::AInsideB], counts.undecided, kPoses, counts.bounds[counts.bounds.size() / 2] * 1e3,
        counts.bounds[counts.bounds.size() * 9 / 10] * 1e3);
    return counts;
}

class QueryAgainstFcl : public ::testing::Test {
protected:
    /// Both outcomes must be met often, and the bound must decide nearly always.
    static void expectDecided(const Counts& counts, double most_undecided) {
        EXPECT_GT(counts[Relation::Apart], kPoses / 10);
        EXPECT_GT(counts[Relation::SurfacesIntersect], kPoses / 10);
        EXPECT_LE(counts.undecided, most_undecided * kPoses) << "a bound that decides nothing proves nothing";
    }
    Random random_{2026};
};

// Truth: independent program (FCL 0.7, collide and distance of BVH OBBRSS models) for intersection and separation;
// containment, which FCL calls free, by ray parity; depth by branch and bound over the whole surface.

TEST_F(QueryAgainstFcl, BumpyBallsAgreeWithinTheStatedBound) {
    // Truth: independent program (FCL 0.7), ray parity and dense geometry for what it cannot say; see above
    test::MeshPair pair = pairOf("small bumpy ball, bumpy ball", test::bumpyBall(0.02), test::bumpyBall(0.009));
    const Counts counts = compare(pair, random_);
    expectDecided(counts, 0.15);
    EXPECT_GT(counts[Relation::BInsideA], kPoses / 20);
}

TEST_F(QueryAgainstFcl, BoxInsideAndOutsideOfACylinderAgreesWithinTheStatedBound) {
    // Truth: independent program (FCL 0.7), ray parity and dense geometry for what it cannot say; see above
    test::MeshPair pair = pairOf("small box, big cylinder", shape::tessellate(shape::Box{0.005, 0.006, 0.004}, 5e-6),
                                 shape::tessellate(shape::Cylinder{0.018, 0.014}, 5e-6));
    const Counts counts = compare(pair, random_);
    expectDecided(counts, 0.15);
    EXPECT_GT(counts[Relation::AInsideB], kPoses / 20);
}

TEST_F(QueryAgainstFcl, PegAndBorePlateAgreeWithinTheStatedBound) {
    // Truth: independent program (FCL 0.7), ray parity and dense geometry for what it cannot say; see above. The plate
    // has no room for the peg within its walls.
    test::MeshPair pair =
        pairOf("peg, bore plate", shape::tessellate(shape::BorePlate{0.016, 0.016, 0.008, 0.0064, 0.006, 0.5e-3}, 5e-6),
               shape::tessellate(shape::Peg{0.006, 0.012, 0.5e-3}, 5e-6));
    const Counts counts = compare(pair, random_);
    expectDecided(counts, 0.15);
    EXPECT_EQ(counts[Relation::BInsideA] + counts[Relation::AInsideB], 0);
}

}  // namespace
}  // namespace passung
