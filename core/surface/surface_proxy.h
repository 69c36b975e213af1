#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/contact/contact_query.h"
#include "core/motion/constrained_motion.h"
#include "core/motion/metric.h"
#include "core/motion/pull.h"
#include "core/surface/contact_row.h"
#include "core/surface/pair_forest.h"
#include "core/surface/surface_body.h"

namespace passung::surface {

struct SurfaceSettings {
    motion::Metric metric = {};  // of the held part's motions
    double gap = 1e-6;           // held between the parts where there is room for it [m]
    int budget = 38000;          // units of work in a tick
};

/// What a tick did.
struct SurfaceTick {
    Pose X_WG;
    double gap = 0.0;        // proven: no two triangles are nearer at X_WG [m]; at most SurfaceProxy::kSeen
    bool suspended = false;  // the budget ended: what was begun goes on in the next tick
    bool waits = false;      // the common way was not free all along: it goes on in the next tick
    bool meets = false;      // the parts overlap, as at a start in overlap: they are being set apart
    bool stuck = false;      // no motion was found within the bounds on rounds
    int looks = 0;
    int rounds = 0;  // motions solved for
    int work = 0;
    int rows = 0, active = 0;  // conditions, and those that hold the pose
    int turns = 0;             // of friction, most of one motion (friction_balance.h)
    bool unbalanced = false;   // some friction found no balance
};

/// Keeps a held part's triangles from ever meeting those of bodies while it follows a hand. Bodies rest while it moves
/// and may be moved in between.
///
/// Source: a kinetic certificate for each pair of clusters (Basch, Guibas, Hershberger 1997) instead of a measured
/// overlap; the motion by Gauss's principle of least constraint under the rows of those pairs that it would violate
/// (constrained_motion.h).
///
/// Invariant: with X = X_BG the accepted pose seen from a body, each pair of faces, one of either, is covered by one
/// pair of clusters, which is either asleep with key k, so that its distance is at least k - S, or near, with a plane
/// (n, s) of the body's frame: its hulls are set apart by s > 0 along n. S is the way travelled toward planes like the
/// one that set the sleeping pair apart: for each class of normals it grows by the most that any point of the part came
/// nearer to such a plane (approach.h). Nothing else is assumed of the meshes: no inside, no closedness.
///
/// A look: rows -> nearest pose to the hand -> all pairs whose key is due wake -> each near pair must be set apart at
/// the new pose AND on the way there -> those that are not become rows, and it is solved again. A pose is accepted only
/// when all are proven; u = 0 always is, so that no force and no budget causes an overlap.
/// The way: with n fixed, n · a(t) ≥ min(n · a(0), n · a(1)) - e, e = R θ²/8 the rise of an arc of radius R over its
/// chord. With n turning from n0 to n1 the separation is a polynomial in t of second degree: it stays above its least
/// Bernstein coefficient  n0·a0 - h0,  ½(n0·a1 + n1·a0 - h0 - h1),  n1·a1 - h1,  less e.
/// A cluster's hull is proven from one number: any x within r of c has  n · Δx ≥ n · Δc - |Dᵀ n| r,  D = R1 - R0.
///
/// A body that moved, from X_BG to X_BG' while the held part rested: a plane of its frame moved with it, so that
/// against it the part went from one pose to the other. No way between is assumed. What is known at X_BG' is less:
///   asleep  n · x' ≥ n · x - d, d the most of class of n by (R' - R, p' - p): S grows by d, the key holds;
///   near    s' = s + n · Δc - |Dᵀ n| r, as above; one that is left with too little is sorted anew, as are those asleep
///           that are due now. Until then the part stays where it is, however many ticks of work that is;
///   rows    features of either frame: only where they are now differs. The look that was begun is given up.
/// After a motion above kVoid nothing of the body is known, and it is found out from the roots.
///
/// Parts in other hands (common_way.cpp). Who looks at two ticks sees both go at once, each straight from where it was.
/// So all that is proven of a look is proven for the way from where both were when the tick began, too, as either sees
/// the other: of pairs asleep by what is left of their keys where the part goes back there, of near pairs by planes. A
/// look of which it is not true is halved, and given up after some times (SurfaceTick::waits). u = 0 always is true:
/// the other's way was, while this part rested. So only the last place counts, whatever lies between.
///
/// No crossing: movers take turns. While one moves all others rest, so that its own proof holds against the frame of
/// each, for its whole way; then each of the others is told (moveBody), and begins its own way with what is true at
/// that pose. Two faces are apart at each pose of any way, and each way begins where the one before has ended. A body
/// moved together with the part leaves all of it as it is: only relative poses are kept.
///
/// Friction: each look's motion is that of friction.h under the same rows, each a corner of what touches. How far a
/// patch bears torsion is measured where faces lie on each other (touching_pieces.h). What slid in the last look that
/// was made slides on; a tick that makes none is a rest.
///
/// Bodies out of reach: boxes that are farther apart than any tick goes. Nothing of them is kept or looked at.
///
/// Held by rows, and for three ticks after that, or let go by another hand's part until it is with its own, the proxy
/// goes no faster than kFastestHeld, or half as fast again as the hand or a body that gives way: past an edge it slides
/// through several ticks, and the force with it. Where rows turn with the pose, a look goes farther than they say
/// (relaxation()).
///
/// A start in overlap: where triangles cross, out along what faces them and along the hand, until none do. Then, and at
/// each place, it is asked whether something lies wholly within the other part (enclosure.h): if so, the held part goes
/// the way out that was found, in a straight line. Both at kFastest at most; no face counts as a contact meanwhile.
///
/// Limit cases: nothing near → the hand. One plane → the hand's projection onto it, one gap away. Where two sides leave
/// less than 8 gaps, the gap shrinks to an eighth of what is there. Rounding: kWelded and 1e-10 m, which are 1/100 of
/// the least gap. One body whose frame is the world's: the same bits as without frames.
class SurfaceProxy {
public:
    /// The trees outlive this. @pre less than 65 536 bodies
    SurfaceProxy(const ClusterTree& held, std::span<const SurfaceBody> bodies, const SurfaceSettings& settings);
    /// One body, at rest in the world's frame.
    SurfaceProxy(const ClusterTree& held, const ClusterTree& obstacles, const SurfaceSettings& settings);

    /// Puts the held part somewhere; the past is void. rt-safe; the next ticks find out what is near.
    void place(const Pose& X_WG) noexcept;
    /// The held part is held otherwise from now on. rt-safe.
    void measureBy(const motion::Metric& metric) noexcept;
    /// Finds out what is near, whatever it takes. For the time before the first tick.
    void prepare();

    /// How much work a tick may be from now on, > 0: what other hands have left. rt-safe.
    void setBudget(int budget) noexcept { budget_ = settings_.budget = budget; }

    /// Where the hand itself is in the next tick, which advance() may not be asked to follow, and how far the hands
    /// have gone that hold bodies [m]. Unless that is told, a body's own way counts as its hand's. `pressed`: by one
    /// that another hand moves, which may hold it without a row of its own. rt-safe.
    void setHands(const Pose& X_WH, double others_way, bool pressed) noexcept {
        X_WH_told_ = X_WH;
        others_way_ = others_way;
        let_go_ = let_go_ || pressed;
        pressed_ = pressed;
    }

    /// Body `i` is in another hand, and was at X_WB when the tick began, the held part where it is now. From then on
    /// parts stay apart also on the straight way that both go at once from there. rt-safe.
    void beginTick(std::size_t i, const Pose& X_WB) noexcept;
    /// Body `i` is in no other hand any more. rt-safe.
    void leaveBody(std::size_t i) noexcept { bodies_[i].common = {}; }
    /// Body `i` has gone to X_WB while the held part rested; whoever moved it proved that no triangles met on the
    /// way. What has to be found out about it is work of the next tick. rt-safe, bounded.
    void moveBody(std::size_t i, const Pose& X_WB) noexcept;
    /// Puts body `i` somewhere, maybe over the held part; what was known of it is void. rt-safe, bounded.
    void placeBody(std::size_t i, const Pose& X_WB) noexcept;

    /// Follows the hand, or what two hands draw the part by, with `X_WH` where it would rest. rt-safe, bounded by the
    /// budget.
    const SurfaceTick& advance(const Pose& X_WH, const motion::Pull* pull = nullptr) noexcept;

    /// Rows that hold the pose: those with `push` > 0. Each is of a face of its `body`, in that frame.
    std::span<const ContactRow> rows() const noexcept { return {rows_.data(), row_count_}; }
    /// Which triangle of the body's tree it is of.
    std::uint32_t triangleOf(const ContactRow& row) const noexcept {
        return (*bodies_[row.body].tree)[row.obstacle].triangle;
    }
    /// Its normal and where it acts, world.
    Vec3 normalOf(const ContactRow& row) const noexcept { return bodies_[row.body].directionInWorld(row.n); }
    Vec3 pointOf(const ContactRow& row) const noexcept {
        const KnownBody& body = bodies_[row.body];
        return body.inWorld(row.point(body.P));
    }
    /// How far the proxy may go against it before it holds, at the pose of now [m].
    double roomOf(const ContactRow& row) const noexcept { return row.gapAt(bodies_[row.body].P) - gap_; }
    /// Where the last motion rubbed. `obstacle` is the place in the list of all bodies' `rubbing`, one after the other.
    const motion::FrictionPatches& patches() const noexcept { return patches_; }
    const Pose& pose() const noexcept { return X_; }
    /// The poses accepted in the last tick, in order.
    std::span<const Pose> chain() const noexcept { return {chain_.data(), chain_count_}; }
    /// How far the hand's pose lies beyond the row that it presses most [m], ≥ 0.
    double handDepth(const Pose& X_WH) const noexcept;

    static constexpr double kSeen = 8e-6;         // [m]: farther pairs are not told apart
    static constexpr double kLeastGap = 1e-7;     // [m]
    static constexpr double kFastest = 1e-3;      // of the proxy where the hand is slower [m/tick]
    static constexpr double kFastestHeld = 5e-5;  // and where rows hold it [m/tick]
    static constexpr double kVoid = 3e-3;         // of a body at once: farther, it is found anew [m]
    static constexpr std::size_t kMostLooks = 16;
    static constexpr std::size_t kMostRows = 96;

private:
    struct NearPair {
        Vec3 n, n_next;    // plane now and after the look
        double s, s_next;  // separation by it [m]
        Vec3 centre;       // and
        double radius;     // of the held hull's ball, part frame [m]
        std::uint32_t pair;
        bool meets;  // triangles cross: no plane yet
        bool faces;  // it cannot be split
        CornerSeed seed;
        std::uint16_t body;
    };
    struct PlaneAt {
        Placement X;
        Vec3 n;
    };
    enum class Phase : std::uint8_t { Idle, Waking, Checking };
    enum class Checked : std::uint8_t { Passed, Violated, Astray, Spent };

    // surface_bodies.cpp
    bool knowsItsSide() noexcept;
    const SurfaceTick& lead() noexcept;
    double clearanceOf(const KnownBody& body) const noexcept;
    void findReach() noexcept;
    double reach() const noexcept;
    void forget(std::size_t i) noexcept;
    void giveUpLook() noexcept;
    void ask(KnownBody& body) noexcept;
    void release(std::size_t at) noexcept;
    void moveNear() noexcept;
    bool catchUp() noexcept;

    // common_way.cpp
    double strayOf(const KnownBody& body) const noexcept;
    void lookBack() noexcept;
    void measureCommonWay(KnownBody& body) const noexcept;
    bool keepsCommonWay(const NearPair& near) noexcept;
    bool crossedAtBegin(std::size_t i) noexcept;
    bool shorten() noexcept;

    // surface_proof.cpp
    HullPair hulls(std::uint32_t pair) const noexcept;
    /// True if a look that is accepted now takes what is left.
    bool spent() const noexcept { return tick_.work >= budget_ - std::min(static_cast<int>(near_count_), budget_ / 4); }
    void setSleeps(std::size_t i) noexcept;
    bool settle() noexcept;
    void sort(std::uint32_t at, double any) noexcept;
    void push(std::uint32_t pair, const Vec3& n, double s, bool meets) noexcept;
    void fallAsleep(std::uint32_t at, const Vec3& n, double s) noexcept;
    std::uint32_t splitPair(std::uint32_t at) noexcept;
    bool trySplit(std::size_t at) noexcept;
    double needOf(double s, bool faces) const noexcept;
    Checked check() noexcept;
    bool proves(NearPair& near) noexcept;
    bool provesFaces(NearPair& near, const HullPair& pair, double swept) noexcept;
    bool provesParts(const NearPair& near, const HullPair& pair, const Vec3& n_end, double need) noexcept;
    bool provesTurning(const HullPair& pair, const PlaneAt& from, const PlaneAt& to, double need) const noexcept;
    bool staysApart(const HullPair& pair, const PlaneAt& from, const PlaneAt& to, double need) noexcept;
    Pose poseOnWay(double share) const noexcept;
    void addRow(NearPair& near) noexcept;
    void accept() noexcept;

    // surface_proxy.cpp
    double wayBetween(const Placement& from, const Placement& to) const noexcept;
    void limit(double most) noexcept;
    void refreshRows() noexcept;
    void adaptGap() noexcept;
    void solve() noexcept;
    std::uint32_t surfaceOf(std::size_t body, std::uint32_t face) const noexcept;
    void findTouching() noexcept;
    double relaxation() const noexcept;
    double goodEnough() const noexcept;
    bool isHeld() const noexcept;
    motion::Motion wayOut() const noexcept;
    bool beginLook(const Pose& X_WH) noexcept;
    void measureNearer() noexcept;
    double shareKnown() const noexcept;
    bool wakeAll() noexcept;
    void bendRows() noexcept;
    bool tryAgain(bool violated) noexcept;
    HullPair hulls(const ContactRow& row) const noexcept;
    bool isGhost(const ContactRow& row, const Placement& X) noexcept;
    bool dropsGhosts() noexcept;
    bool dropsTwins() noexcept;
    void refineLeast() noexcept;
    void tell() noexcept;

    const ClusterTree* held_;
    std::vector<KnownBody> bodies_;
    SurfaceSettings settings_;
    int budget_;

    PairForest forest_;
    std::vector<NearPair> near_;
    std::size_t near_count_ = 0, front_ = 0;  // those before `front_` failed in this look
    std::vector<ContactRow> rows_;
    std::size_t row_count_ = 0;
    contact::ContactManifold manifold_;

    // Of what rubs.
    std::vector<motion::Friction> friction_;       // of all surfaces; empty: nothing does
    std::vector<motion::TouchingPiece> touching_;  // where faces lie on each other, at the tick's begin
    std::size_t touching_count_ = 0;
    motion::FrictionPatches patches_, rubbed_;  // of the last motion; of the last that was made, or began a rest

    Pose X_;                    // accepted
    Placement P_;               // the same
    double gap_, least_ = 0.0;  // held; the least proven at X_ [m]
    double last_way_ = 0.0;     // in the last tick [m]
    int since_held_ = 0;        // ticks
    bool overlaps_ = false;
    bool asks_ = true;           // of some body whether something lies wholly within the other part
    bool moved_ = false;         // some body was, and what is known of it was not brought up to date
    double travelled_ = 0.0;     // since the part was placed [m]
    double hurry_ = 1.0;         // of a look's way: less where bodies that move stop it again and again
    int owed_ = 0;               // work since the last tick
    double swept_ = 0.0;         // the farthest that a body has moved since then, seen from the part [m]
    Vec3 lead_ = Vec3::Zero();   // the way out of it, unit, world
    double left_to_lead_ = 0.0;  // [m]
    std::optional<Pose> X_WH_last_, X_WH_told_;
    double others_way_ = 0.0;                // as it was told [m]
    bool pressed_ = false, let_go_ = false;  // by another hand's part; and until it is where it is asked to go

    // Of the tick.
    const motion::Pull* pull_ = nullptr;           // where it is more than one hand's spring
    double trust_ = 0.0, way_in_tick_ = 0.0;       // [m]
    double most_in_tick_ = 0.0, most_held_ = 0.0;  // of the way, and where rows hold the pose [m]

    // Of the look that was begun.
    Phase phase_ = Phase::Idle;
    Pose X_WH_, X_next_;
    motion::Motion rest_ = motion::Motion::Zero();  // what rows leave of the way to the hand, at the look's begin
    motion::Motion rest_before_ = motion::Motion::Zero(), gone_ = motion::Motion::Zero();  // and the look before
    Placement P_next_;
    motion::Motion wanted_ = motion::Motion::Zero(), u_ = motion::Motion::Zero();
    double most_way_ = 0.0, way_ = 0.0, arc_ = 0.0, ease_ = 0.0, least_share_ = 1.0;
    std::size_t at_ = 0, wakes_ = 0;
    bool front_only_ = false, violated_ = false, limited_ = false;
    int added_ = 0, rounds_ = 0, ghosts_ = 0, shortened_ = 0;

    SurfaceTick tick_;
    std::array<Pose, kMostLooks> chain_;
    std::size_t chain_count_ = 0;
};

}  // namespace passung::surface
