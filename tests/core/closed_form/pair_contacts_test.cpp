#include "core/closed_form/pair_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/closed_form/shape_pairs.h"
#include "tests/support/length.h"

namespace passung::closed_form {
namespace {

constexpr double kRho = 22.4e-3;  // [m]

/// Turned about the point of the part that is held, which goes by Δx.
Pose movedBy(const Pose& X, const motion::Motion& u, const Vec3& grip) {
    const Quat turn = rotationFromVector(u.tail<3>() / kRho);
    const Vec3 held = X * grip;
    Pose there{turn * X.q, held + u.head<3>() + turn * (X.p - held)};
    there.q.normalize();
    return there;
}

/// The gap of the contact that this one becomes after a motion; nothing if it is gone.
std::optional<double> gapAfter(const SolidPair& pair, const Pose& X, const Contact& contact, const motion::Motion& u) {
    ContactSearch search(pair);
    PairContacts found;
    search.find(movedBy(X, u, pair.metric.p_GC), 2e-3, found);
    std::optional<double> gap;
    double least = 0.05;  // of the line's parameter
    for (const Contact& other : found.all()) {
        const bool same = other.name == contact.name && other.touch.kind == contact.touch.kind &&
                          other.touch.a == contact.touch.a && other.touch.b == contact.touch.b;
        const double apart = std::abs(other.touch.t - contact.touch.t);
        if (!same || apart > least) continue;
        least = apart;
        gap = other.gap;
    }
    return gap;
}

motion::Motion along(int i, double size) {
    motion::Motion u = motion::Motion::Zero();
    u[i] = size;
    return u;
}

struct Differences {
    motion::Motion first = motion::Motion::Zero();
    MotionMatrix second = MotionMatrix::Zero();
};

/// By finite differences of the minimum itself, found anew at each pose; nothing where it does not exist all around.
std::optional<Differences> differencesOf(const SolidPair& pair, const Pose& X, const Contact& contact) {
    constexpr double kFirst = 2e-6, kSecond = 2e-5;  // [m]
    bool there = true;
    const auto gap = [&](const motion::Motion& u) {
        const auto value = gapAfter(pair, X, contact, u);
        there = there && value;
        return value.value_or(0.0);
    };
    Differences d;
    motion::Motion up, down;
    for (int i = 0; i < 6; ++i) {
        d.first[i] = (gap(along(i, kFirst)) - gap(along(i, -kFirst))) / (2.0 * kFirst);
        up[i] = gap(along(i, kSecond));
        down[i] = gap(along(i, -kSecond));
    }
    for (int i = 0; i < 6; ++i) {
        for (int k = 0; k < 6; ++k) {
            const motion::Motion u = along(i, kSecond) + along(k, kSecond);
            d.second(i, k) = i == k ? up[i] - 2.0 * contact.gap + down[i]
                                    : 0.5 * (gap(u) + gap(-u) + 2.0 * contact.gap - up[i] - up[k] - down[i] - down[k]);
        }
    }
    d.second /= kSecond * kSecond;
    if (!there) return std::nullopt;
    return d;
}

double quantile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

class ContactsOfShapes : public testing::TestWithParam<ShapePair> {};

TEST_P(ContactsOfShapes, ChangeWithAMotionAsTheirRowsAndCurvaturesSay) {
    // Truth: finite differences of the minimum itself. What they lack themselves grows with the curvature's own change,
    // so that minima which are about to vanish are left out.
    const auto held = solidOf(GetParam().held), obstacle = solidOf(GetParam().obstacle);
    Random random(2);
    const Pose X_WO{randomRotation(random, 3.0), randomVector(random, Vec3::Constant(0.01))};
    const SolidPair at_origin{&*held, &*obstacle, X_WO, motion::Metric{kRho}},
        at_a_grip{&*held, &*obstacle, X_WO, motion::Metric{kRho, Vec3(0.011, -0.007, 0.02)}};
    std::vector<double> first, second;
    const std::size_t wanted = test::atFullLength() ? 150 : 70;
    for (int tried = 0; tried < 4000 && first.size() < wanted; ++tried) {
        const SolidPair& pair = tried % 2 == 0 ? at_origin : at_a_grip;
        const Pose X = X_WO * Pose{randomRotation(random, GetParam().tilt),
                                   GetParam().start + randomVector(random, GetParam().amplitude)};
        ContactSearch search(pair);
        PairContacts found;
        search.find(X, 1e-3, found);
        for (const Contact& contact : found.all()) {
            if (contact.touch.kind == Touch::Kind::Fixed || contact.gap < -1e-3) continue;
            const MotionMatrix H = curvatureOf(pair, X, contact, true);
            if (H.norm() > 1e4) continue;
            const auto d = differencesOf(pair, X, contact);
            if (!d) continue;
            first.push_back((d->first - contact.a).norm());
            second.push_back((d->second - H).norm() / std::max(H.norm(), 10.0));
            break;
        }
    }
    ASSERT_GT(first.size(), 60u);
    EXPECT_LT(quantile(first, 0.5), 1e-5);
    EXPECT_LT(quantile(first, 0.9), 1e-4);
    EXPECT_LT(quantile(second, 0.5), 2e-3);
    EXPECT_LT(quantile(second, 0.9), 2e-2);
}

/// Along a thread only bounds above 0 say anything.
void expectNoDeeperThanBound(const Curve& edge, const Lump& lump) {
    for (std::size_t i = 0; i < piecesOf(edge); ++i) {
        const LinePiece piece = pieceOf(edge, i);
        ThreadSamples samples;
        samples.take(edge, piece);
        Touches touches;
        const double bound = searchAlongThread(edge, piece, samples, lump, 1e-3, touches);
        if (!(bound > 0.0)) continue;
        double least = 1.0;
        for (int k = 0; k <= 400; ++k)
            least = std::min(least, valueOf(lump, pointOf(edge, piece.begin + k / 400.0 * (piece.end - piece.begin))));
        ASSERT_LE(bound, least + 1e-12);
    }
}

TEST_P(ContactsOfShapes, HaveTheirEdgesNoDeeperThanTheirBounds) {
    // Truth: the lump's function itself at dense points of the edge.
    const auto held = solidOf(GetParam().held), obstacle = solidOf(GetParam().obstacle);
    Random random(7);
    for (int tried = 0; tried < 300; ++tried) {
        const Pose X{randomRotation(random, GetParam().tilt),
                     GetParam().start + randomVector(random, GetParam().amplitude)};
        for (Curve edge : held->edges) {
            edge.centre = X * edge.centre;
            edge.e1 = X.q * edge.e1;
            edge.e2 = X.q * edge.e2;
            edge.e3 = X.q * edge.e3;
            for (const Lump& lump : obstacle->lumps) {
                if (edge.kind == Curve::Kind::Spiral || hasFlank(lump)) {
                    ASSERT_NO_FATAL_FAILURE(expectNoDeeperThanBound(edge, lump));
                    continue;
                }
                Touches touches;
                double closer = -1.0;
                const double bound = searchEdge(edge, lump, 1e-3, touches, &closer);
                double least = 1.0;
                for (int i = 0; i <= 400; ++i)
                    least = std::min(least, valueOf(lump, pointOf(edge, edge.end * (i / 200.0 - 1.0))));
                ASSERT_LE(bound, least + 1e-12);
                ASSERT_LE(closer, least + 1e-12);
            }
        }
    }
}

TEST_P(ContactsOfShapes, OverlapByAsMuchAsTheDeepestOfThemForASearchThatLooksAtFewOnly) {
    // Truth: the deepest of all contacts, found anew at each pose, to the bit; on slow and fast ways.
    const auto held = solidOf(GetParam().held), obstacle = solidOf(GetParam().obstacle);
    Random random(6);
    const Pose X_WO{randomRotation(random, 3.0), randomVector(random, Vec3::Constant(0.01))};
    const SolidPair pair{&*held, &*obstacle, X_WO, motion::Metric{kRho}};
    int overlaps = 0;
    for (const double step : {2e-5, 5e-4}) {
        ContactSearch search(pair);
        Vec3 p = GetParam().start;
        Quat q = Quat::Identity();
        for (int i = 0; i < 500; ++i) {
            if (i % 100 == 0) {
                p = GetParam().start + randomVector(random, GetParam().amplitude);
                q = randomRotation(random, GetParam().tilt);
            }
            p += randomVector(random, Vec3::Constant(step));
            q = (randomRotation(random, 40.0 * step) * q).normalized();
            const Pose X = X_WO * Pose{q, p};
            PairContacts all;
            ContactSearch(pair).find(X, 0.0, all);
            const ContactSearch::Overlap found = search.overlapAt(X);
            ASSERT_EQ(found.depth, overlapOf(all)) << i;
            ASSERT_LE(found.full, all.full());
            overlaps += found.depth > 0.0 ? 1 : 0;
        }
    }
    EXPECT_GT(overlaps, 50);
}

TEST_P(ContactsOfShapes, AreTheSameForASearchThatRemembersWhatIsFar) {
    // Truth: invariant.
    const auto held = solidOf(GetParam().held), obstacle = solidOf(GetParam().obstacle);
    const SolidPair pair{&*held, &*obstacle, {}, motion::Metric{kRho}};
    Random random(3);
    ContactSearch remembers(pair);
    Vec3 p = GetParam().start;
    Quat q = Quat::Identity();
    for (int i = 0; i < 400; ++i) {
        p += randomVector(random, Vec3::Constant(5e-4));
        q = randomRotation(random, 0.02) * q;
        const Pose X{q.normalized(), p};
        PairContacts one, other;
        remembers.find(X, 1e-3, one);
        ContactSearch(pair).find(X, 1e-3, other);
        ASSERT_EQ(one.all().size(), other.all().size()) << i;
        for (std::size_t k = 0; k < one.all().size(); ++k) EXPECT_EQ(one.all()[k].gap, other.all()[k].gap);
    }
}

TEST(ContactsOfRims, AreTwoWhereARimCrossesTwoFacesBetweenTwoSamples) {
    // Truth: the lump's function at dense points of the mouth's rim. A tick of the shipped study: the peg's tip stands
    // on the mouth's rim, which meets its chamfer 11 degrees further, both within 15 degrees.
    const auto peg = solidOf(shape::Peg{.02, .05, .0005});
    const auto plate = solidOf(shape::BorePlate{.06, .06, .03, .0202, .025, .0005});
    const Pose X{
        Quat(0.9998910427093506, -0.010717242024838924, 0.01015303935855627, -1.4173131603456568e-05).normalized(),
        Vec3(-0.0007147965952754021, -0.0008499546092934906, -0.0002800616784952581)};
    double deepest = 0.0;
    for (int i = 0; i < 100'000; ++i)
        deepest =
            std::min(deepest, valueOf(peg->lumps[0], X.inverse() * pointOf(plate->edges[1], 2e-5 * M_PI * i - M_PI)));
    PairContacts found;
    ContactSearch({&*peg, &*plate, {}, motion::Metric{kRho}}).find(X, 1e-3, found);
    EXPECT_LT(deepest, -3e-6);
    EXPECT_NEAR(-overlapOf(found), deepest, 2e-8);
}

INSTANTIATE_TEST_SUITE_P(All, ContactsOfShapes, testing::ValuesIn(allPairs()), nameOfPair);

}  // namespace
}  // namespace passung::closed_form
