#include "core/motion/constrained_motion.h"

#include <algorithm>
#include <cmath>

namespace passung::motion {

std::size_t binOf(const Vec3& gradient, const Vec3& lever) noexcept {
    std::size_t bin = 0;
    for (int i = 0; i < 3; ++i) bin = bin << 2 | (gradient[i] < 0.0 ? 2u : 0u) | (lever[i] < 0.0 ? 1u : 0u);
    return bin;
}

MotionSolver::MotionSolver(const Surroundings& around, std::span<const std::uint32_t> likely) noexcept
    : around_(around) {
    for (const std::uint32_t place : likely.first(std::min<std::size_t>(likely.size(), 6))) {
        const int before = count_;
        addRow(around.contacts[place]);
        if (count_ > before)
            last_active_[static_cast<std::size_t>(last_active_count_++)] = rows_[static_cast<std::size_t>(before)];
    }
}

/// What a contact asks of g · motion [m], if that can be had.
double MotionSolver::wantedOf(const contact::ContactPoint& contact) const noexcept {
    return (contact.phi < around_.keep_out ? around_.sunk_out : around_.keep_out) - contact.phi;
}

double MotionSolver::least(const contact::ContactPoint& contact) const noexcept {
    const double b = wantedOf(contact);
    return relaxed_ || contact.radius > 0.0 ? std::min(b, 0.0) : b;
}

double MotionSolver::boundOf(const MotionRow& row) const noexcept {
    return relaxed_ || row.sphere ? std::min(row.b, 0.0) : row.b;
}

void MotionSolver::addRow(const contact::ContactPoint& contact) noexcept {
    const double gradient = contact.gradient.norm();
    if (!(gradient > kLeastGradient)) return;
    MotionRow& row = rows_[static_cast<std::size_t>(count_++)];
    row.a = around_.rowOf(contact.position, contact.gradient);
    row.length = row.a.norm();
    row.a /= row.length;
    row.b = wantedOf(contact) / row.length;
    row.gradient = gradient;
    row.contact = static_cast<std::uint32_t>(&contact - around_.contacts.begin());
    row.sphere = contact.radius > 0.0;
    row.bound = boundOf(row);
}

const MotionRow* MotionSolver::mostViolated(const Motion& u) const noexcept {
    double violation = tolerance_;
    const MotionRow* worst = nullptr;
    for (int i = 0; i < count_; ++i) {
        const MotionRow& row = rows_[static_cast<std::size_t>(i)];
        const double missing = (row.bound - row.a.dot(u)) * row.length;
        if (!(missing > violation)) continue;
        violation = missing;
        worst = &row;
    }
    return worst;
}

/// True if `u` violates contacts that were not met so far; they now are.
bool MotionSolver::meetsMore(const Motion& u) noexcept {
    const Surroundings::Carried carried = around_.carriedBy(u);
    std::array<double, kBins> worst;
    std::array<const contact::ContactPoint*, kBins> which{};
    worst.fill(tolerance_);
    for (const contact::ContactPoint& contact : around_.contacts) {
        const double missing = least(contact) - contact.gradient.dot(carried.of(contact.position));
        if (!(missing > tolerance_)) continue;
        const std::size_t bin =
            binOf(contact.gradient, (contact.position - around_.metric.centre).cross(contact.gradient));
        if (!(missing > worst[bin]) || !(contact.gradient.squaredNorm() > kLeastGradient * kLeastGradient)) continue;
        worst[bin] = missing;
        which[bin] = &contact;
    }
    if (count_ + static_cast<int>(kBins) > kMostRows) {  // forget what does not hold
        std::copy_n(last_active_.begin(), last_active_count_, rows_.begin());
        count_ = last_active_count_;
    }
    const int before = count_;
    for (const contact::ContactPoint* contact : which)
        if (contact != nullptr) addRow(*contact);
    return count_ > before;
}

/// False if the rows have no common solution.
bool MotionSolver::attempt(const Motion& wanted, ConstrainedMotion& result) noexcept {
    for (MotionRow& row : std::span(rows_).first(static_cast<std::size_t>(count_))) row.bound = boundOf(row);
    ActiveSet active;
    for (MotionRow& row : std::span(last_active_).first(static_cast<std::size_t>(last_active_count_))) {
        row.bound = boundOf(row);
        active.tryAdd(row, 0.0);
    }
    result.u = active.start(wanted);
    result.iterations = 0;
    result.converged = true;
    while (true) {
        const MotionRow* worst = mostViolated(result.u);
        if (worst == nullptr) {
            last_active_count_ = active.size();
            for (int i = 0; i < last_active_count_; ++i) last_active_[static_cast<std::size_t>(i)] = active.row(i);
            if (meetsMore(result.u)) worst = mostViolated(result.u);
        }
        if (worst == nullptr) break;
        const auto taken = active.takeUp(MotionRow(*worst), result.u, result.iterations, kMaxIterations);
        if (taken == ActiveSet::Taken::Infeasible) return false;
        if (taken == ActiveSet::Taken::Capped) {
            result.converged = false;
            break;
        }
    }
    result.active = last_active_count_ = active.size();
    for (int i = 0; i < active.size(); ++i) {
        const MotionRow& row = last_active_[static_cast<std::size_t>(i)] = active.row(i);
        result.active_contacts[static_cast<std::size_t>(i)] = {row.contact,
                                                               active.lambda(i) * row.gradient / row.length};
    }
    return true;
}

ConstrainedMotion MotionSolver::solve(const Motion& wanted) noexcept {
    tolerance_ = std::max(kMotionTolerance, 2.0 * ActiveSet::kIndependent * wanted.norm());
    relaxed_ = false;
    ConstrainedMotion result;
    bool found = attempt(wanted, result);
    const double bend = (result.u - wanted).norm();
    if (!(found && result.converged && bend <= wanted.norm())) {
        double deepest = 0.0;  // what standing still would leave to be removed
        for (const contact::ContactPoint& contact : around_.contacts) deepest = std::max(deepest, least(contact));
        if (deepest > 0.0 && !(found && result.converged && bend <= wanted.norm() + kFarther * deepest)) {
            relaxed_ = result.relaxed = true;
            found = attempt(wanted, result);
        }
    }
    if (!found) {  // rounding only: these rows allow u = 0
        result.u.setZero();
        result.active = last_active_count_ = 0;
        result.converged = false;
    }
    return result;
}

ConstrainedMotion constrainMotion(const Motion& wanted, const Surroundings& around,
                                  std::span<const std::uint32_t> likely) noexcept {
    return MotionSolver(around, likely).solve(wanted);
}

}  // namespace passung::motion
