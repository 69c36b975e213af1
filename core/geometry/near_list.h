#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/mesh.h"

namespace passung::geometry {

/// A part around which the held one moves: a box that holds all of it.
struct NearPart {
    Bounds box;          // in its frame [m]
    Pose X_WP;           // where it rests
    bool moves = false;  // it does not rest: always near, until NearList::rest
};

/// Which of many parts are near a held one, from pose to pose, without looking at those that cannot be. (Own; keys by
/// motion instead of time as in kinetic data structures, Basch, Guibas, Hershberger 1997.)
///
/// Symbols: B_G, B_i boxes that hold the held part and part i; c, r centre and radius of a box's ball;
///   g_i(X) = max(d(c_G, B_i) - r_G, d(c_i, B_G) - r_i), d the distance of a point from a box: a bound that no two
/// points of held part and part i are nearer than, wherever it is > 0, since each part lies in its box and its ball.
///   From X to X' no point p of B_G goes farther than w = |x' - x| + |R' - R|₂ R_G, R_G = max |p|, with
/// |R' - R|₂ = 2 sin(θ/2) ≤ 2 min(|q' - q|, |q' + q|). Both of g_i's distances change by no more than c_G or a point of
/// B_G goes, so that g_i(X') ≥ g_i(X) - w.
///   S is the sum of all w so far. A part that was looked at when it was S, and was g_i away, is asleep with the key
/// k_i = S + g_i: at any later pose  g_i ≥ k_i - S.  So one that was not looked at, k_i > S + reach, is farther than
/// `reach` at that pose, whatever way led there, jumps included. Who knows that and moves by no more than `reach` from
/// there has not come to it on the way either.
///   Rounding: each w is added with S 2⁻⁵² more, so that S is never too small; kRounding covers that of g_i.
/// Work: those that are near, each time; of the others those that are due, O(log n) each. A part that is g away is due
/// after the held one has gone so far. After a jump of more than kJump all are looked at once, O(n).
/// Limit cases: at most kAll parts that rest → all are near, always. A pose that is not finite → all are due.
/// Invariant: the same parts as if each one's g_i were compared with `reach` (Search::Each).
class NearList {
public:
    static constexpr std::size_t kAll = 4;
    static constexpr double kRounding = 1e-9;  // [m]
    static constexpr double kJump = 0.05;      // [m]

    NearList() = default;
    /// `held`: in its frame. Allocates all that is ever needed.
    NearList(const Bounds& held, std::span<const NearPart> parts);

    /// Those with g_i ≤ `reach` with the held part at `X_WG`, and those that move; ascending. Valid until the next
    /// call. rt-safe.
    std::span<const std::uint32_t> within(const Pose& X_WG, double reach) noexcept;

    /// Part `i` does not rest any more, and is at `X_WP` now: always near. O(n) where it was asleep. rt-safe.
    void carry(std::uint32_t i, const Pose& X_WP) noexcept;
    /// Part `i` rests where it is now. rt-safe.
    void rest(std::uint32_t i) noexcept {
        if (!hasAll()) moves_[i] = 0;
    }

    /// All parts are always near.
    bool hasAll() const noexcept { return sleeping_.empty(); }
    /// g_i [m]. @pre !hasAll(), `i` rests. rt-safe.
    double gap(std::uint32_t i, const Pose& X_WG) const noexcept;
    /// Parts that were looked at so far.
    std::uint64_t looks() const noexcept { return looks_; }

    /// How the near ones are found, for tests: as above; by a look at each; all are taken for near.
    enum class Search : std::uint8_t { Keys, Each, All };
    void searchBy(Search search) noexcept { search_ = search; }

private:
    struct Ball {
        Vec3 centre = Vec3::Zero(), half = Vec3::Zero();  // of the box [m]
        double radius = 0.0;
    };
    struct Placed {
        Ball ball;  // centre in the world, half along its own axes
        Quat q_PW;
    };
    struct Sleep {
        double key;
        std::uint32_t part;
    };

    static Ball ballOf(const Bounds& box);
    void place(std::uint32_t i, const Pose& X_WP) noexcept;
    void travel(const Pose& X_WG) noexcept;
    void putToSleep(std::uint32_t part, double gap) noexcept;
    double lookAt(std::uint32_t part, const Pose& X_WG) noexcept {
        ++looks_;
        return gap(part, X_WG);
    }

    Ball held_;              // in its frame
    double farthest_ = 0.0;  // R_G [m]
    std::vector<Placed> parts_;
    std::vector<Vec3> centres_;    // of their boxes, in their frames
    std::vector<Sleep> sleeping_;  // a heap, the least key first: the first `asleep_`
    std::size_t asleep_ = 0;
    std::vector<std::uint32_t> near_, woken_, merged_, all_;  // the first `near_count_`
    std::size_t near_count_ = 0;
    std::vector<std::uint8_t> moves_;
    Pose X_last_;
    double travelled_ = 0.0;  // S [m]
    bool placed_ = false;     // at X_last_
    Search search_ = Search::Keys;
    std::uint64_t looks_ = 0;
};

}  // namespace passung::geometry
