#include "core/closed_form/pair_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/closed_form/shape_pairs.h"

namespace passung::closed_form {
namespace {

constexpr double kRho = 22.4e-3;  // [m]

Pose movedBy(const Pose& X, const motion::Motion& u) {
    Pose there{rotationFromVector(u.tail<3>() / kRho) * X.q, X.p + u.head<3>()};
    there.q.normalize();
    return there;
}

/// The gap of the contact that this one becomes after a motion; nothing if it is gone.
std::optional<double> gapAfter(const SolidPair& pair, const Pose& X, const Contact& contact, const motion::Motion& u) {
    ContactSearch search(pair);
    PairContacts found;
    search.find(movedBy(X, u), 2e-3, found);
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
    const SolidPair pair{&*held, &*obstacle, X_WO, kRho};
    std::vector<double> first, second;
    for (int tried = 0; tried < 4000 && first.size() < 150; ++tried) {
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

TEST_P(ContactsOfShapes, AreTheSameForASearchThatRemembersWhatIsFar) {
    // Truth: invariant.
    const auto held = solidOf(GetParam().held), obstacle = solidOf(GetParam().obstacle);
    const SolidPair pair{&*held, &*obstacle, {}, kRho};
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

INSTANTIATE_TEST_SUITE_P(All, ContactsOfShapes, testing::ValuesIn(allPairs()), nameOfPair);

}  // namespace
}  // namespace passung::closed_form
