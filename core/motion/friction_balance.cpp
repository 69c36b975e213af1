#include "core/motion/friction_balance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace passung::motion {

namespace {

constexpr double kSettled = 1e-4;    // of σ, after the last turn
constexpr double kUnsettled = 20.0;  // what is left to change, per last change
constexpr double kAtRest = 1e-6;     // slip relative to the wanted motion w
constexpr double kInner = 0.05;      // what cuts may leave, per last change of σ
/// σ has settled when a turn changes it by no more than this, relative to w.
///   From above: kUnsettled times as much may be left to change. That shall be a tenth of what counts as slip, so that
/// no patch rests or slides by what has not settled: 1e-7 |w|. Contacts rise or sink by μ times that, half of what they
/// may err by anyway (2e-7 |w|); of a hand drawn off by 10 mm, 10 N at 1 N/mm, 1 nm.
///   From below: of rows that are only just independent rounding moves u by up to ε/kIndependent = 2.2e-9 |w|; what is
/// less may never be reached.
constexpr double kTurnTolerance = 0.1 * kAtRest / kUnsettled;
static_assert(kTurnTolerance > std::numeric_limits<double>::epsilon() / ActiveSet::kIndependent);
constexpr double kFarthestMix = 20.0;
constexpr double kLongestGradient = 1.2;  // of an interpolated φ
constexpr int kMostRounds = 200;

}  // namespace

FrictionBalance::FrictionBalance(const Motion& wanted, const Surroundings& around, std::span<const Friction> friction,
                                 const ConstrainedMotion& plain, const FrictionPatches& before) noexcept
    : wanted_(wanted),
      around_(around),
      friction_(friction),
      before_(before),
      size_(wanted.norm()),
      tolerance_(std::max(kMotionTolerance, 2.0 * ActiveSet::kIndependent * size_)),
      fine_(1e-13 * size_),
      relaxed_(plain.relaxed),
      u_(plain.u) {
    std::array<int, 6> patch_of;
    for (int i = 0; i < plain.active; ++i) {
        const ActiveContact& held = plain.active_contacts[static_cast<std::size_t>(i)];
        const contact::ContactPoint& contact = around.contacts[held.contact];
        const int at = patch_of[static_cast<std::size_t>(i)] = patchFor(contact);
        Patch& patch = patches_[static_cast<std::size_t>(at)];
        // Without any pressure the first contact is the centre; a weight that no other feels.
        const double push = std::max(held.push, 1e-12 * size_ + std::numeric_limits<double>::min());
        patch.pressure += push;
        patch.moment += push * contact.position;
    }
    for (int p = 0; p < patch_count_; ++p) {
        Patch& patch = patches_[static_cast<std::size_t>(p)];
        patch.is.centre = patch.moment / patch.pressure;
        patch.is.radius = effectiveRadius(around, patch.is, u_);
        place(patch);
        patch.slip = patch.B * u_;
        goOn(patch);
        // On one plane friction takes so much of the slip.
        if (patch.is.slides && !(patch.given > 0.0))
            patch.given = std::max(0.0, patch.slip.norm() - coefficientOf(patch) * patch.pressure);
    }
    for (int i = 0; i < plain.active; ++i) {
        const int at = patch_of[static_cast<std::size_t>(i)];
        const Patch& patch = patches_[static_cast<std::size_t>(at)];
        const Vec3 along = patch.is.impulse.norm() > 0.0 ? Vec3(-patch.is.impulse) : patch.slip;
        addCut(plain.active_contacts[static_cast<std::size_t>(i)].contact, at,
               along.norm() > kAtRest * size_ ? Vec3(along.normalized()) : Vec3(Vec3::Zero()));
        active_.tryAdd(rows_[static_cast<std::size_t>(i)], 0.0);
        watch({plain.active_contacts[static_cast<std::size_t>(i)].contact, at, Vec3::Zero()});
    }
    u_ = active_.start(wanted_);
}

/// What `patch` has of the motion before.
void FrictionBalance::goOn(Patch& patch) const noexcept {
    bool slid = false;
    for (int k = 0; k < before_.count; ++k) {
        const FrictionPatch& old = before_.patch[static_cast<std::size_t>(k)];
        if (old.obstacle != patch.is.obstacle) continue;
        slid = slid || old.slides;
        if (!(old.normal.dot(patch.is.normal) > kSameWay)) continue;
        patch.is.slides = old.slides;
        patch.is.impulse = turned(old, patch.is.normal);
        patch.given = old.slides ? old.slip : 0.0;
        return;
    }
    patch.is.slides = slid && slipOf(around_, patch.is, before_.motion).norm() > kAtRest * size_;
}

double FrictionBalance::coefficientOf(const Patch& patch) const noexcept {
    const Friction& rough = friction_[patch.is.obstacle];
    return patch.is.slides ? rough.sliding : rough.at_rest;
}

void FrictionBalance::place(Patch& patch) const noexcept {
    const auto [t1, t2] = tangentsOf(patch.is.normal);
    const PlacedMetric& metric = around_.metric;
    const Vec3 torsion = metric.isRound() ? Vec3(patch.is.radius / metric.radius * patch.is.normal)
                                          : metric.perTurn(patch.is.radius * patch.is.normal);
    Motion about;
    about << Vec3::Zero(), torsion;
    patch.B << around_.rowOf(patch.is.centre, t1).transpose(),  //
        around_.rowOf(patch.is.centre, t2).transpose(),         //
        around_.unbentRow(about).transpose();
}

int FrictionBalance::patchFor(const contact::ContactPoint& contact) noexcept {
    const Vec3 normal = contact.gradient.normalized();
    int best = -1;
    double most = -2.0;
    for (int p = 0; p < patch_count_; ++p) {
        const FrictionPatch& is = patches_[static_cast<std::size_t>(p)].is;
        const double cosine = is.normal.dot(normal);
        if (is.obstacle != contact.obstacle || !(cosine > most)) continue;
        most = cosine;
        best = p;
    }
    if (most > kSameWay || (best >= 0 && patch_count_ == kMostPatches)) return best;
    if (patch_count_ == kMostPatches) return 0;
    Patch& patch = patches_[static_cast<std::size_t>(patch_count_)];
    patch.is.normal = normal;
    patch.is.centre = contact.position;
    patch.is.obstacle = contact.obstacle;
    place(patch);
    patch.slip = patch.B * u_;
    goOn(patch);
    return patch_count_++;
}

double FrictionBalance::least(const contact::ContactPoint& contact) const noexcept {
    const double b = (contact.phi < around_.keep_out ? around_.sunk_out : around_.keep_out) - contact.phi;
    return relaxed_ || contact.radius > 0.0 ? std::min(b, 0.0) : b;
}

void FrictionBalance::buildRow(int cut) noexcept {
    const Cut& is = cuts_[static_cast<std::size_t>(cut)];
    const contact::ContactPoint& contact = around_.contacts[is.contact];
    const Patch& patch = patches_[static_cast<std::size_t>(is.patch)];
    MotionRow& row = rows_[static_cast<std::size_t>(cut)];
    row.gradient = contact.gradient.norm();
    const double rough = coefficientOf(patch) * row.gradient;
    row.a = around_.rowOf(contact.position, contact.gradient);
    row.a -= rough * patch.B.transpose() * is.direction;
    row.length = row.a.norm();
    row.a /= row.length;
    row.b = row.bound = (least(contact) - rough * patch.given) / row.length;
    row.contact = static_cast<std::uint32_t>(cut);
    row.sphere = contact.radius > 0.0;
}

void FrictionBalance::addCut(std::uint32_t contact, int patch, const Vec3& direction) noexcept {
    assert(cut_count_ < kMostCuts);
    cuts_[static_cast<std::size_t>(cut_count_)] = {contact, patch, direction};
    buildRow(cut_count_++);
}

/// By how much the motion of now violates the cone of a contact [m].
double FrictionBalance::violationOf(const contact::ContactPoint& contact, const Patch& patch) const noexcept {
    return least(contact) - contact.gradient.dot(around_.wayOf(contact.position, u_)) +
           coefficientOf(patch) * contact.gradient.norm() * (patch.slip.norm() - patch.given);
}

/// Remembers a contact that a motion has violated; when too many are, those that do not hold are forgotten.
void FrictionBalance::watch(const Cut& contact) noexcept {
    const auto end = watched_.begin() + static_cast<std::ptrdiff_t>(watched_count_);
    if (std::any_of(watched_.begin(), end, [&](const Cut& w) { return w.contact == contact.contact; })) return;
    if (watched_count_ == kMostWatched) {
        watched_count_ = 0;
        for (; static_cast<int>(watched_count_) < active_.size(); ++watched_count_)
            watched_[watched_count_] = cuts_[active_.row(static_cast<int>(watched_count_)).contact];
    }
    watched_[watched_count_++] = contact;
}

/// Adds tangents of the contacts that hold, where the motion of now violates these by more than `enough`.
bool FrictionBalance::cutActive(double enough) noexcept {
    const int before = cut_count_;
    for (int i = 0; i < active_.size(); ++i) {
        const Cut cut = cuts_[active_.row(i).contact];
        const Patch& patch = patches_[static_cast<std::size_t>(cut.patch)];
        const double slip = patch.slip.norm();
        if (slip > 0.0 && violationOf(around_.contacts[cut.contact], patch) > std::max(fine_, enough))
            addCut(cut.contact, cut.patch, patch.slip / slip);
    }
    return cut_count_ > before;
}

/// Room for a tangent in every bin.
void FrictionBalance::makeRoom() noexcept {
    if (cut_count_ + static_cast<int>(kBins) > kMostCuts) restart();
}

/// Adds the tangents that the motion of now violates most, of the contacts that are watched or of all. @pre makeRoom()
bool FrictionBalance::cutAmong(bool all, double enough) noexcept {
    const double least_violation = std::max(tolerance_, enough);
    double lift = 0.0;
    for (const Patch& patch : std::span(patches_).first(static_cast<std::size_t>(patch_count_)))
        lift = std::max(lift, coefficientOf(patch) * (patch.slip.norm() - patch.given));
    const Surroundings::Carried carried = around_.carriedBy(u_);
    std::array<double, kBins> worst;
    std::array<Cut, kBins> which;
    worst.fill(least_violation);
    const std::size_t count = all ? around_.contacts.size() : watched_count_;
    for (std::size_t i = 0; i < count; ++i) {
        const contact::ContactPoint& contact = around_.contacts[all ? i : watched_[i].contact];
        const double missing = least(contact) - contact.gradient.dot(carried.of(contact.position));
        if (!(missing + kLongestGradient * lift > least_violation)) continue;
        if (!(contact.gradient.squaredNorm() > kLeastGradient * kLeastGradient)) continue;
        const int at = all ? patchFor(contact) : watched_[i].patch;
        const Patch& patch = patches_[static_cast<std::size_t>(at)];
        const double slip = patch.slip.norm(), violation = violationOf(contact, patch);
        const std::size_t bin =
            binOf(contact.gradient, (contact.position - around_.metric.centre).cross(contact.gradient));
        if (!(violation > worst[bin])) continue;
        worst[bin] = violation;
        which[bin] = {static_cast<std::uint32_t>(&contact - around_.contacts.begin()), at,
                      slip > 0.0 ? Vec3(patch.slip / slip) : Vec3(Vec3::Zero())};
    }
    const int before = cut_count_;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
        if (!(worst[bin] > least_violation)) continue;
        addCut(which[bin].contact, which[bin].patch, which[bin].direction);
        watch(which[bin]);
    }
    return cut_count_ > before;
}

/// Adds tangents of the contacts that hold, when these are content of those that are watched, and then (`all`) of all.
/// False if the motion of now violates none by more than `enough`.
bool FrictionBalance::cutOff(double enough, bool all) noexcept {
    makeRoom();
    noteSlips();
    return cutActive(enough) || cutAmong(false, enough) || (all && cutAmong(true, enough));
}

/// Slips of the motion of now.
void FrictionBalance::noteSlips() noexcept {
    for (Patch& patch : std::span(patches_).first(static_cast<std::size_t>(patch_count_))) patch.slip = patch.B * u_;
}

/// Forgets what does not hold, and finds anew what the rows that do leave of the motion.
void FrictionBalance::restart() noexcept {
    std::array<Cut, 6> held;
    const int count = active_.size();
    for (int i = 0; i < count; ++i) held[static_cast<std::size_t>(i)] = cuts_[active_.row(i).contact];
    active_ = ActiveSet();
    cut_count_ = 0;
    for (int i = 0; i < count; ++i) {
        const Cut& cut = held[static_cast<std::size_t>(i)];
        addCut(cut.contact, cut.patch, cut.direction);
        active_.tryAdd(rows_[static_cast<std::size_t>(i)], 0.0);
    }
    u_ = active_.start(wanted_);
    noteSlips();
}

/// The row that the motion violates most, or -1. Rows that rub have to hold more exactly: what they miss is slip.
int FrictionBalance::mostViolated() const noexcept {
    double violation = 0.0;
    int worst = -1;
    for (int i = 0; i < cut_count_; ++i) {
        const MotionRow& row = rows_[static_cast<std::size_t>(i)];
        const double missing = (row.bound - row.a.dot(u_)) * row.length;
        const bool rubs = cuts_[static_cast<std::size_t>(i)].direction != Vec3::Zero();
        if (!(missing > std::max(violation, rubs ? fine_ : tolerance_))) continue;
        violation = missing;
        worst = i;
    }
    return worst;
}

/// The convex problem, up to cuts of `enough`, of the watched contacts or of all. False if its rows have no common
/// solution.
bool FrictionBalance::solveCuts(double enough, bool all) noexcept {
    for (; rounds_ < kMostRounds; ++rounds_) {
        for (int worst = mostViolated(); worst >= 0; worst = mostViolated()) {
            const MotionRow row = rows_[static_cast<std::size_t>(worst)];
            const ActiveSet before = active_;
            const Motion u_before = u_;
            const auto taken = active_.takeUp(row, u_, iterations_, kMostSteps);
            if (taken == ActiveSet::Taken::Infeasible) {
                if ((row.bound - row.a.dot(u_before)) * row.length > tolerance_) return false;
                active_ = before;  // no more exactly than this
                u_ = u_before;
                cuts_[static_cast<std::size_t>(worst)].direction.setZero();
                buildRow(worst);
            }
            if (taken == ActiveSet::Taken::Capped) {
                converged_ = false;
                return true;
            }
        }
        if (!cutOff(enough, all)) return true;
    }
    converged_ = false;
    return true;
}

/// Pressure, friction and slip of the patches in the motion of now.
void FrictionBalance::measure() noexcept {
    for (int p = 0; p < patch_count_; ++p) {
        Patch& patch = patches_[static_cast<std::size_t>(p)];
        patch.pressure = 0.0;
        patch.moment.setZero();
        patch.is.impulse.setZero();
        patch.slip = patch.B * u_;
    }
    for (int i = 0; i < active_.size(); ++i) {
        const MotionRow& row = active_.row(i);
        const Cut& cut = cuts_[row.contact];
        Patch& patch = patches_[static_cast<std::size_t>(cut.patch)];
        const double push = active_.lambda(i) * row.gradient / row.length;
        patch.pressure += push;
        patch.moment += push * around_.contacts[cut.contact].position;
        patch.is.impulse -= coefficientOf(patch) * push * cut.direction;
    }
}

/// σ → |s|, and (`centres`) the centres of pressure; by how much that changes the problem [m]. What slips when σ is
/// about to settle slides.
double FrictionBalance::turn(bool centres) noexcept {
    double change = 0.0, along = 0.0, squared = 0.0, moved = 0.0;
    for (int p = 0; p < patch_count_; ++p) {
        Patch& patch = patches_[static_cast<std::size_t>(p)];
        if (centres && patch.pressure > 1e-9 * size_) {
            const Vec3 centre = patch.moment / patch.pressure;
            moved =
                std::max(moved, (centre - patch.is.centre).norm() / around_.metric.radius * patch.is.impulse.norm());
            patch.is.centre = centre;
            place(patch);
        }
        const double slip = patch.slip.norm(), off = slip - patch.given;
        change = std::max(change, std::abs(off));
        along += off * (off - patch.off);
        squared += (off - patch.off) * (off - patch.off);
    }
    // Anderson's mixing with one step of memory, where the steps shrink.
    const double mix =
        change < last_change_ && squared > 0.0 ? std::clamp(along / squared, -kFarthestMix, kFarthestMix) : 0.0;
    last_change_ = change;
    for (int p = 0; p < patch_count_; ++p) {
        Patch& patch = patches_[static_cast<std::size_t>(p)];
        const double slip = patch.slip.norm();
        patch.off = slip - patch.given;
        patch.given = std::max(0.0, slip - mix * (slip - patch.slip_before));
        patch.slip_before = slip;
    }
    change = std::max(change, moved);
    const double left = change;
    for (int p = 0; p < patch_count_; ++p) {
        Patch& patch = patches_[static_cast<std::size_t>(p)];
        const double slip = patch.slip.norm();
        if (patch.is.slides || !(slip > kAtRest * size_ + kUnsettled * left)) continue;
        patch.is.slides = true;
        last_change_ = 0.0;
        change = std::max(change, slip);
    }
    return change;
}

/// What holds the motion, and the patches that bear something.
void FrictionBalance::tell(FrictionMotion& result) const noexcept {
    result.motion.u = u_;
    result.motion.relaxed = relaxed_;
    result.motion.iterations = iterations_;
    result.patches.motion = around_.motionOf(u_);
    for (int i = 0; i < active_.size(); ++i) {
        const MotionRow& row = active_.row(i);
        const ActiveContact held{cuts_[row.contact].contact, active_.lambda(i) * row.gradient / row.length};
        int to = 0;
        while (to < result.motion.active &&
               result.motion.active_contacts[static_cast<std::size_t>(to)].contact != held.contact)
            ++to;
        ActiveContact& into = result.motion.active_contacts[static_cast<std::size_t>(to)];
        into = {held.contact, to < result.motion.active ? into.push + held.push : held.push};
        result.motion.active = std::max(result.motion.active, to + 1);
    }
    for (int p = 0; p < patch_count_; ++p) {
        const Patch& patch = patches_[static_cast<std::size_t>(p)];
        if (!(patch.pressure > 0.0)) continue;
        FrictionPatch& into = result.patches.patch[static_cast<std::size_t>(result.patches.count++)];
        into = patch.is;
        into.pressure = patch.pressure;
        into.slip = patch.slip.norm();
        into.slides = into.slides && patch.slip.norm() > (kAtRest + kUnsettled * result.change) * size_;
    }
}

FrictionMotion FrictionBalance::find() noexcept {
    FrictionMotion result;
    bool settled = false, all = true;
    for (int sweep = 0; sweep < kFrictionSweeps && !settled; ++sweep) {
        // What cuts leave is quadratic in what is off.
        const double enough = last_change_ * std::min(kInner, last_change_ / size_);
        bool found = solveCuts(enough, all);
        if (!found && !relaxed_) {
            relaxed_ = true;
            active_ = ActiveSet();
            cut_count_ = 0;
            u_ = wanted_;
            found = solveCuts(0.0, true);
        }
        converged_ = converged_ && found;
        measure();
        result.sweeps = sweep + 1;
        const double change = turn(sweep < kFrictionSweeps / 2);
        result.change = change / size_;
        const bool still = change <= kTurnTolerance * size_;
        if (still)
            makeRoom();
        else
            restart();
        all = still && found && cutAmong(true, 0.0);  // some more are not content
        settled = still && !all;
    }
    result.converged = settled || result.change <= kSettled;
    if (!settled) {
        if (!result.converged)
            for (Patch& patch : patches_) patch.given = 0.0;
        restart();
        converged_ = solveCuts(0.0, true) && converged_;
        measure();
    }
    result.converged = result.converged && converged_;
    tell(result);
    return result;
}

}  // namespace passung::motion
