#include "analysis/truth/contact_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>
#include <optional>

#include "core/base/random.h"
#include "core/geometry/parallel.h"

namespace passung::truth {

namespace {

// Shares of SHELL's longest side.
constexpr std::array kGaps{0.1, 0.02, 0.004};
constexpr std::array kDepths{0.001, 0.002, 0.004, 0.01, 0.02};
constexpr double kSlideDepth = 0.004, kSlideStep = 0.005;
constexpr double kTouch = 2e-5;   // so near is touching
constexpr double kMet = 0.02;     // of a depth: so near to it is near enough, what is reached is what counts
constexpr double kSearch = 1e-4;  // resolution of the depth while searching
constexpr std::size_t kSearchPieces = 5'000;
constexpr int kSlides = 3, kCorrections = 4;
constexpr int kMarch = 400, kPress = 60, kTries = 40, kHomes = 33;
constexpr double kTilt = 5.0 * std::numbers::pi / 180.0;
constexpr double kShakenTilt = 0.02;  // [rad]
constexpr double kShaken = 0.01;

Vec3 anyDirection(Random& random) {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    return Vec3(x, y, z).normalized();
}

Quat anyRotation(Random& random) {
    const double w = random.normal(), x = random.normal(), y = random.normal(), z = random.normal();
    return Quat(w, x, y, z).normalized();
}

Vec3 anyPointIn(const geometry::Bounds& box, double share, Random& random) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    return 0.5 * (box.low + box.high) + 0.5 * share * box.size().cwiseProduct(Vec3(x, y, z));
}

/// Poses with aligned frames at which SHELL is free and its middle lies in FIELD's box.
std::vector<Pose> freeHomes(const PairTruth& truth) {
    std::vector<Pose> homes;
    const geometry::Bounds& box = truth.fieldBounds();
    const double reach = 0.5 * (box.size() + truth.shellBounds().size()).maxCoeff();
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < kHomes; ++i) {
            Pose home;
            home.p[axis] = reach * (2.0 * i / (kHomes - 1) - 1.0);
            const Vec3 low = home.p + truth.shellBounds().low, high = home.p + truth.shellBounds().high;
            // Boxes that share at least a tenth of SHELL's shortest side along every axis.
            const Vec3 shared = high.cwiseMin(box.high) - low.cwiseMax(box.low);
            if (shared.minCoeff() < 0.1 * truth.shellBounds().size().minCoeff()) continue;
            if (truth.rough().relationAt(home).relation == Relation::Apart) homes.push_back(home);
        }
    }
    return homes;
}

struct Start {
    Pose X_FS;
    Vec3 direction;  // unit, FIELD's axes
};

Start startOf(const PairTruth& truth, const std::vector<Pose>& homes, int path, Random& random) {
    if (path % 2 == 1 && !homes.empty()) {
        const Pose home = homes[random.below(homes.size())];
        return {home, anyDirection(random)};
    }
    const Quat turn =
        path % 4 == 0 ? anyRotation(random) : rotationFromVector(kTilt * random.uniform() * anyDirection(random));
    const Vec3 direction = anyDirection(random);
    const Vec3 aim = anyPointIn(truth.fieldBounds(), 0.6, random);
    const Vec3 middle = 0.5 * (truth.shellBounds().low + truth.shellBounds().high);
    const double far = truth.fieldBounds().size().norm() + truth.shellBounds().size().norm();
    return {{turn, aim - turn * middle - far * direction}, direction};
}

/// One path; nothing if it passes FIELD.
class Path {
public:
    Path(const PairTruth& truth, const Start& start, Truth asked)
        : truth_(truth), rough_(truth.rough()), start_(start), asked_(asked), unit_(truth.length()) {}

    std::optional<std::vector<JudgedPose>> walk(Random& random) {
        const auto touch = approach();
        if (!touch) return std::nullopt;
        std::vector<JudgedPose> poses;
        const auto add = [&](const Pose& X_FS, const char* phase) {
            poses.push_back({X_FS, asked_ == Truth::Whole ? truth_.at(X_FS) : truth_.quicklyAt(X_FS), phase});
        };
        for (const double gap : kGaps) add(at(std::max(0.0, *touch - gap * unit_)), kApproach);
        double s = *touch, slide_from = *touch;
        for (const double depth : kDepths) {
            s = press(s, depth * unit_);
            if (depth == kSlideDepth) slide_from = s;
            add(at(s), "pressed");
        }
        Vec3 along = anyDirection(random);
        along = (along - along.dot(start_.direction) * start_.direction).normalized();
        for (int i = 1; i <= kSlides; ++i) {
            Pose X_FS = at(slide_from);
            X_FS.p += i * kSlideStep * unit_ * along;
            for (int k = 0; k < kCorrections; ++k) X_FS.p += (kSlideDepth * unit_ + distance(X_FS)) * start_.direction;
            add(X_FS, "slide");
        }
        return poses;
    }

private:
    Pose at(double s) const { return {start_.X_FS.q, start_.X_FS.p + s * start_.direction}; }
    double distance(const Pose& X_FS) const { return rough_.distanceAt(X_FS, kSearch * unit_, kSearchPieces).distance; }

    /// How far to first contact: by sure steps, as long as the distance left.
    std::optional<double> approach() const {
        const double end = 2.0 * (truth_.fieldBounds().size().norm() + truth_.shellBounds().size().norm());
        double s = 0.0;
        for (int i = 0; i < kMarch && s < end; ++i) {
            const PoseTruth truth = rough_.relationAt(at(s));
            if (truth.relation != Relation::Apart || truth.separation < kTouch * unit_) return s;
            s += truth.separation;
        }
        return std::nullopt;
    }

    /// On from `s` until the surface is `depth` inside: no step can be too long, for the depth grows at most as fast.
    double press(double s, double depth) const {
        for (int i = 0; i < kPress; ++i) {
            const double left = depth + distance(at(s));
            if (left < kMet * depth) break;
            s += left;
        }
        return s;
    }

    const PairTruth &truth_, &rough_;  // what is said of a pose, and what it is searched by
    Start start_;
    Truth asked_;
    double unit_;
};

/// body(i) for all i on all cores, with reports.
template <class Body>
void forEach(std::size_t count, const ProgressReport& report, const Body& body) {
    std::mutex one_at_a_time;
    std::size_t done = 0;
    geometry::parallelFor(count, [&](std::size_t i) {
        body(i);
        const std::lock_guard lock(one_at_a_time);
        report(static_cast<double>(++done) / static_cast<double>(count));
    });
}

}  // namespace

std::vector<JudgedPose> contactPath(const PairTruth& truth, int paths, std::uint64_t seed, const ProgressReport& report,
                                    Truth asked) {
    const std::vector<Pose> homes = freeHomes(truth);
    std::vector<std::vector<JudgedPose>> found(static_cast<std::size_t>(paths));
    forEach(found.size(), report, [&](std::size_t i) {
        Random random(seed * 1'000'003 + i);
        for (int attempt = 0; attempt < kTries && found[i].empty(); ++attempt) {
            Path path(truth, startOf(truth, homes, static_cast<int>(i), random), asked);
            if (auto poses = path.walk(random)) found[i] = std::move(*poses);
        }
    });
    std::vector<JudgedPose> all;
    for (const auto& poses : found) all.insert(all.end(), poses.begin(), poses.end());
    return all;
}

std::vector<JudgedPose> judgePoses(const PairTruth& truth, const std::vector<Pose>& poses,
                                   const ProgressReport& report) {
    std::vector<JudgedPose> judged(poses.size());
    forEach(poses.size(), report, [&](std::size_t i) { judged[i] = {poses[i], truth.at(poses[i])}; });
    return judged;
}

std::vector<JudgedPose> shakenPoses(const PairTruth& truth, const std::vector<JudgedPose>& near, int count,
                                    std::uint64_t seed, const ProgressReport& report) {
    std::vector<JudgedPose> poses(static_cast<std::size_t>(count));
    const geometry::Bounds& box = truth.fieldBounds();
    const double reach = 0.5 * truth.shellBounds().size().norm();
    forEach(poses.size(), report, [&](std::size_t i) {
        Random random(seed * 2'000'003 + i);
        Pose& X_FS = poses[i].X_FS;
        if (i % 2 == 0 && !near.empty()) {
            X_FS = near[(i / 2) % near.size()].X_FS;
            X_FS.p += kShaken * truth.length() * random.uniform(-1, 1) * anyDirection(random);
            X_FS.q = (rotationFromVector(kShakenTilt * random.uniform() * anyDirection(random)) * X_FS.q).normalized();
        } else {
            const geometry::Bounds around{box.low - Vec3::Constant(reach), box.high + Vec3::Constant(reach)};
            X_FS = {anyRotation(random), anyPointIn(around, 1.0, random)};
        }
        poses[i].truth = truth.relationAt(X_FS);
        poses[i].phase = "shaken";
    });
    return poses;
}

}  // namespace passung::truth
