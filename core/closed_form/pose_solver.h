#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/closed_form/pair_contacts.h"
#include "core/geometry/near_list.h"
#include "core/motion/friction.h"
#include "core/motion/pull.h"

namespace passung::closed_form {

/// A contact that held the proxy, and what it pushed with: `push` times the coupling's stiffness is its force [m].
struct HeldContact {
    Contact contact;
    std::uint16_t pair = 0;
    double push = 0.0;
    int age = 0;  // looks since it was last found as a minimum
};

/// What held the pose that was found last: all that one tick leaves to the next.
struct PoseMemory {
    std::array<HeldContact, 6> held{};
    std::size_t count = 0;
    motion::FrictionPatches rubbing;  // of the last motion that was made, or that began a rest

    std::span<const HeldContact> all() const noexcept { return {held.data(), count}; }
};

struct ConstrainedPose {
    Pose X_WG;             // the proxy
    double overlap = 0.0;  // there [m]
    int iterations = 0;
    bool converged = true;  // false: the looks were used up, or nothing was allowed
    bool full = false;      // more contacts than there is room for: PairContacts::full()
    motion::Motion pull =
        motion::Motion::Zero();  // what is left of the way to the hand [m]: the spring's wrench over K
};

inline constexpr int kMostLooks = 24;
inline constexpr int kFewestLooks = 6;
inline constexpr int kMostMeetings = 2400;      // ContactSearch::meetings() times looks: what has many has fewer looks
inline constexpr int kThreadLooks = 12;         // the same with threads, whose looks take longer
inline constexpr int kMostRubs = 300;           // rows of friction in a solve, after which no look is begun
inline constexpr double kLongestLook = 2.5e-4;  // of |u| in a look near an obstacle [m]
inline constexpr double kLongestWay = 7e-4;     // of any point of the held part in such a look [m]
inline constexpr double kMostRise = 1e-7;       // of any point's arc over its chord in such a look [m]
inline constexpr double kMostAstray = 6e-5;     // of |u| of looks since the last pose without overlap [m]
inline constexpr double kReach = 1e-3;          // within which contacts become rows: no point goes so far in a look [m]
inline constexpr double kRepair = 1e-4;         // of overlap that was there before, in a solve [m]
inline constexpr double kKeptOverlap = 5e-8;    // [m]
inline constexpr double kStillMoving = 3e-7;    // of |u| in a look: the error left is of second order [m]
inline constexpr double kLeastStiffness = 0.3;  // of the least eigenvalue of B
inline constexpr double kHeldStiffness = 1e5;   // added to B along what holds
inline constexpr double kHeldGap = 1e-6;        // of a row that holds, at most [m]
inline constexpr int kKeptLooks = 6;
inline constexpr double kNearWays = 4.0, kLeastNear = 4e-3;  // [m]

/// Finds the pose nearest to the hand's without overlap, from a free one on:
///   min ½|w|²   s.t.   all gaps ≥ 0,   w the way to the hand's pose in the pairs' metric (motion/metric.h),
/// by sequential quadratic programming: each look minimises ½ uᵀ B u - wᵀ u under a_i · u ≥ -gap_i, B = 1 - Σ λ_i H_i,
/// λ of the look before. B is the algorithm: play of 10 µm with the hand 3 mm away has a constraint of 10 µm radius,
/// past which rows alone run tangentially at every look. There B is not positive, mostly only across rows that hold: as
/// nothing moves across them, each is made stiff, + ½ kHeldStiffness (a_i · u + gap)² of a unit row, which changes no
/// motion that they hold and leaves bare how the energy bends along them (as an augmented Lagrangian does; Nocedal and
/// Wright, Numerical Optimization, 17.3). One that turns out to let go is let go of in the same look. Where the energy
/// bends so along the rows too B's eigenvalues are raised to kLeastStiffness, and where it rests on such a ridge it
/// steps off once. Places where something held stay as rows for some looks (cuts) while their face is the highest
/// there: keptAt(). Contacts whose line could not touch with their normal make no rows: Contact::lean. Where no pose is
/// free, overlap is only kept from growing.
///
/// Nothing is jumped. A pose counts only if it overlaps by no more than kKeptOverlap. On the way from one to the next
/// no point of the held part goes farther than is proven to be free, or than kLongestWay and half the thickness of the
/// thinnest part, which is less than the distance in which contacts are rows: to come to the other side of an obstacle
/// it would have to break rows by more than that, and they are broken by the second order of a look only.
/// A look that goes round a bend ends in overlap of second order. Before the way has gone on by more than kMostAstray
/// since the last pose that counts, a look makes no way but out of that overlap: so a straight line from one pose of
/// way() to the next is as free as they are, give or take kMostRise, where the hand snaps past an edge too.
/// Of many pairs a look takes those that are no farther away than kNearWays times its way to the hand, and kLeastNear,
/// rounded up to a power of two of that (NearList). The way that is proven to be free ends there: what was not looked
/// at is not come to, at no place of a look's motion. Where a power is passed at a pose that was looked at, it is
/// looked at again.
/// A start in overlap comes out by kRepair a solve, the deepest contacts first.
/// Friction: each look's motion is that of motion/friction.h under the same rows and the same B, of which friction has
/// no part: where a look finds u = 0 all forces balance whatever B is. What slid in the last look that was made slides
/// on; a solve whose first look makes no way is a rest. Contacts within kHeldGap are feet, all alike, and bear torsion.
/// What a solver knows of earlier poses changes its time, never its result.
class PoseSolver {
public:
    /// The held part's pairs, with one metric. Their solids outlive this. `near`: of the same parts, in this order;
    /// without one all are near. `friction`: of each pair; none: nothing rubs.
    explicit PoseSolver(std::span<const SolidPair> pairs, geometry::NearList near = {},
                        std::span<const motion::Friction> friction = {});

    /// In at most `most` looks, and no more than kMostMeetings lets it have. `pull`: what draws the
    /// part by, with `X_WH` where it would rest. rt-safe.
    ConstrainedPose solve(const Pose& X_WG, const Pose& X_WH, PoseMemory& memory, int most = kMostLooks,
                          const motion::Pull* pull = nullptr) noexcept;

    /// Obstacle `i` is at `X_WO` from now on. rt-safe.
    void place(std::size_t i, const Pose& X_WO) noexcept {
        if (searches_[i].place(X_WO)) X_found_.reset();
    }

    /// The held part is held at another point from now on. rt-safe.
    void measureBy(const motion::Metric& metric) noexcept;

    /// Poses without overlap that the last solve went through, from its start on: the proxy's way.
    std::span<const Pose> way() const noexcept { return way_.all(); }

    geometry::NearList& near() noexcept { return near_; }

    const SolidPair& pair(std::size_t i) const noexcept { return searches_[i].pair(); }

    /// Where the last look's motion rubbed, for it and its contacts' pushes the same; `obstacle` is the pair.
    const motion::FrictionPatches& patches() const noexcept { return patches_; }

    /// The contacts that the last look found, if it was at this pose: where a solve ends that has converged.
    std::size_t foundCount(const Pose& X) const noexcept { return isFound(X) ? found_ : 0; }
    const HeldContact& found(std::size_t i) const noexcept { return rows_[i].from; }

private:
    static constexpr std::size_t kMostRows = 1024;

    /// A row of a look, with the push that its contact had in the one before.
    struct Row {
        HeldContact from;
        bool slides = true;
        bool stiff = false;  // kHeldStiffness is in the look's B
    };

    bool isFound(const Pose& X) const noexcept {
        return X_found_ && X_found_->p == X.p && X_found_->q.coeffs() == X.q.coeffs();
    }
    double reachFor(const motion::Motion& wanted) const noexcept;
    void find(const Pose& X, double reach) noexcept;
    void remember(const Pose& X, const PoseMemory& memory) noexcept;
    motion::Motion step(const Pose& X, const motion::Motion& wanted, bool back, PoseMemory& memory) noexcept;
    void prepare(const MotionMatrix& L, bool bent) noexcept;
    bool releaseStiff(const motion::ConstrainedMotion& found) noexcept;
    bool factor(const Pose& X, MotionMatrix& L, motion::Motion& wanted) noexcept;
    motion::Motion offRidge(const motion::Motion& way, const PoseMemory& memory) const noexcept;
    bool solveRows(const motion::Motion& wanted, motion::ConstrainedMotion& found) noexcept;
    void rub(const Pose& X, const motion::Motion& wanted, const MotionMatrix* unbent,
             const motion::FrictionPatches& before, motion::ConstrainedMotion& found) noexcept;
    void add(const Row& row) noexcept;
    double wayOf(const motion::Motion& u) const noexcept;
    motion::Motion shortened(const motion::Motion& u) const noexcept;
    Row* successorOf(const HeldContact& old) noexcept;
    double distance(const Contact& contact, const HeldContact& old) const noexcept;

    std::vector<ContactSearch> searches_;
    geometry::NearList near_;
    std::vector<std::uint32_t> all_;  // pairs, where near_ has them all
    std::vector<int> meetings_;       // of each search
    SearchMemory memory_;
    int most_looks_ = kMostLooks;
    PairContacts contacts_;
    std::vector<Row> rows_;                    // kMostRows, the first `count_`
    std::vector<motion::MotionRow> prepared_;  // the same
    std::size_t count_ = 0, found_ = 0;        // rows; those of them that were found at `X_found_`
    double overlap_ = 0.0, free_ = 0.0;        // there; a way that is proven to be free [m]
    std::optional<Pose> X_found_;
    motion::Metric metric_;
    double found_reach_ = 0.0;                        // how near pairs were looked at there [m]
    bool full_ = false;                               // there
    motion::Motion ridge_ = motion::Motion::Zero();   // of the last look: where its B curves down
    double reach_ = 0.0, longest_way_ = kLongestWay;  // of the held part's points
    double sight_ = kReach;                           // within which contacts become rows [m]
    double allowed_ = 0.0;                            // overlap that the solve leaves [m]
    FixedList<Pose, kMostLooks + 1> way_;

    // Of what rubs.
    std::vector<motion::Friction> friction_;  // of each pair, or none
    contact::ContactManifold manifold_;
    motion::FrictionPatches patches_;  // of the last look
    int rubs_ = 0;                     // rows of friction that were taken up or let go in this solve
};

}  // namespace passung::closed_form
