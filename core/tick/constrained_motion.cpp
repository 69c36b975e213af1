#include "core/tick/constrained_motion.h"

#include <algorithm>
#include <cmath>

namespace passung::tick {

namespace {

constexpr double kIndependent = 1e-7;  // a unit row is independent if more than this of it is left
constexpr double kFarther = 4.0;       // per removed overlap: a motion that is bent by more has been sent far away
constexpr std::size_t kBins = 64;      // by the signs of a row's six numbers
constexpr double kNever = std::numeric_limits<double>::infinity();

std::size_t binOf(const Vec3& gradient, const Vec3& lever) noexcept {
    std::size_t bin = 0;
    for (int i = 0; i < 3; ++i) bin = bin << 2 | (gradient[i] < 0.0 ? 2u : 0u) | (lever[i] < 0.0 ? 1u : 0u);
    return bin;
}

}  // namespace

/// The active rows N = Q R and their multipliers.
class MotionSolver::ActiveSet {
public:
    int size() const noexcept { return count_; }
    const Row& row(int i) const noexcept { return rows_[static_cast<std::size_t>(i)]; }
    double& lambda(int i) noexcept { return lambdas_[static_cast<std::size_t>(i)]; }
    const Eigen::Matrix<double, 6, 6>& span() const noexcept { return Q_; }

    /// What of `a` lies in the span, as r = N⁺ a, and what does not, as z = a - N r; by Gram-Schmidt twice.
    void split(const Motion& a, Motion& z, Motion& r) const noexcept {
        Motion q = Motion::Zero();
        z = a;
        for (int pass = 0; pass < 2; ++pass) {
            for (int i = 0; i < count_; ++i) {
                const double along = Q_.col(i).dot(z);
                q[i] += along;
                z -= along * Q_.col(i);
            }
        }
        r.setZero();
        for (int i = count_ - 1; i >= 0; --i) {
            double sum = q[i];
            for (int k = i + 1; k < count_; ++k) sum -= R_(i, k) * r[k];
            r[i] = sum / R_(i, i);
        }
    }

    /// False if the row depends on those that are there, or these are six.
    bool tryAdd(const Row& row, double lambda) noexcept {
        if (count_ == 6) return false;
        Motion rest = row.a;
        R_.col(count_).setZero();
        for (int pass = 0; pass < 2; ++pass) {
            for (int i = 0; i < count_; ++i) {
                const double along = Q_.col(i).dot(rest);
                R_(i, count_) += along;
                rest -= along * Q_.col(i);
            }
        }
        const double left = rest.norm();
        if (!(left > kIndependent)) return false;
        R_(count_, count_) = left;
        Q_.col(count_) = rest / left;
        lambdas_[static_cast<std::size_t>(count_)] = lambda;
        rows_[static_cast<std::size_t>(count_++)] = row;
        return true;
    }

    /// Rows before `which` stay as they are, those behind it move up.
    void drop(int which) noexcept {
        const int end = count_;
        count_ = which;
        for (int i = which + 1; i < end; ++i) {
            const Row row = rows_[static_cast<std::size_t>(i)];
            tryAdd(row, lambdas_[static_cast<std::size_t>(i)]);
        }
    }

    /// λ = (NᵀN)⁻¹ rhs = R⁻¹ R⁻ᵀ rhs.
    Motion multipliersFor(const Motion& rhs) const noexcept {
        Motion y = Motion::Zero();
        for (int i = 0; i < count_; ++i) {
            double sum = rhs[i];
            for (int k = 0; k < i; ++k) sum -= R_(k, i) * y[k];
            y[i] = sum / R_(i, i);
        }
        for (int i = count_ - 1; i >= 0; --i) {
            double sum = y[i];
            for (int k = i + 1; k < count_; ++k) sum -= R_(i, k) * y[k];
            y[i] = sum / R_(i, i);
        }
        return y;
    }

private:
    std::array<Row, 6> rows_;
    std::array<double, 6> lambdas_{};
    Eigen::Matrix<double, 6, 6> Q_ = Eigen::Matrix<double, 6, 6>::Zero(), R_ = Eigen::Matrix<double, 6, 6>::Zero();
    int count_ = 0;
};

MotionSolver::MotionSolver(const Surroundings& around, std::span<const std::uint32_t> likely) noexcept
    : around_(around) {
    for (const std::uint32_t place : likely.first(std::min<std::size_t>(likely.size(), 6))) {
        const int before = count_;
        addRow(around.contacts[place]);
        if (count_ > before) held_[static_cast<std::size_t>(held_count_++)] = rows_[static_cast<std::size_t>(before)];
    }
}

/// What a contact asks of g · motion [m], if that can be had.
double MotionSolver::wantedOf(const ContactPoint& contact) const noexcept {
    return (contact.phi < around_.keep_out ? around_.sunk_out : around_.keep_out) - contact.phi;
}

double MotionSolver::least(const ContactPoint& contact) const noexcept {
    const double b = wantedOf(contact);
    return relaxed_ || contact.radius > 0.0 ? std::min(b, 0.0) : b;
}

double MotionSolver::boundOf(const Row& row) const noexcept {
    return relaxed_ || row.sphere ? std::min(row.b, 0.0) : row.b;
}

void MotionSolver::addRow(const ContactPoint& contact) noexcept {
    const double gradient = contact.gradient.norm();
    if (!(gradient > kLeastGradient)) return;
    Row& row = rows_[static_cast<std::size_t>(count_++)];
    row.a.head<3>() = contact.gradient;
    row.a.tail<3>() = (contact.position - around_.p_WO).cross(contact.gradient) / around_.metric_radius;
    row.length = row.a.norm();
    row.a /= row.length;
    row.b = wantedOf(contact) / row.length;
    row.gradient = gradient;
    row.contact = static_cast<std::uint32_t>(&contact - around_.contacts.begin());
    row.sphere = contact.radius > 0.0;
}

const MotionSolver::Row* MotionSolver::mostViolated(const Motion& u) const noexcept {
    double violation = tolerance_;
    const Row* worst = nullptr;
    for (int i = 0; i < count_; ++i) {
        const Row& row = rows_[static_cast<std::size_t>(i)];
        const double missing = (boundOf(row) - row.a.dot(u)) * row.length;
        if (!(missing > violation)) continue;
        violation = missing;
        worst = &row;
    }
    return worst;
}

bool MotionSolver::meetsMore(const Motion& u) noexcept {
    const Vec3 dphi = u.tail<3>() / around_.metric_radius;
    const Vec3 at_origin = u.head<3>() - dphi.cross(around_.p_WO);
    std::array<double, kBins> worst;
    std::array<const ContactPoint*, kBins> which{};
    worst.fill(tolerance_);
    for (const ContactPoint& contact : around_.contacts) {
        const double missing = least(contact) - contact.gradient.dot(at_origin + dphi.cross(contact.position));
        if (!(missing > tolerance_)) continue;
        const std::size_t bin = binOf(contact.gradient, (contact.position - around_.p_WO).cross(contact.gradient));
        if (!(missing > worst[bin]) || !(contact.gradient.squaredNorm() > kLeastGradient * kLeastGradient)) continue;
        worst[bin] = missing;
        which[bin] = &contact;
    }
    if (count_ + static_cast<int>(kBins) > kMostRows) {  // forget what does not hold
        std::copy_n(held_.begin(), held_count_, rows_.begin());
        count_ = held_count_;
    }
    const int before = count_;
    for (const ContactPoint* contact : which)
        if (contact != nullptr) addRow(*contact);
    return count_ > before;
}

void MotionSolver::startWarm(const Motion& wanted, ActiveSet& active, Motion& u) const noexcept {
    for (int i = 0; i < held_count_; ++i) active.tryAdd(held_[static_cast<std::size_t>(i)], 0.0);
    while (active.size() > 0) {
        Motion missing = Motion::Zero();
        for (int i = 0; i < active.size(); ++i) missing[i] = boundOf(active.row(i)) - active.row(i).a.dot(wanted);
        const Motion lambda = active.multipliersFor(missing);
        int pulls = 0;
        for (int i = 1; i < active.size(); ++i)
            if (lambda[i] < lambda[pulls]) pulls = i;
        if (lambda[pulls] < 0.0) {
            active.drop(pulls);
            continue;
        }
        for (int i = 0; i < active.size(); ++i) {
            active.lambda(i) = lambda[i];
            u += lambda[i] * active.row(i).a;
        }
        return;
    }
}

/// Takes `row` up, letting others go where they are in the way.
MotionSolver::Taken MotionSolver::takeUp(const Row& row, ActiveSet& active, Motion& u, int& iterations) const noexcept {
    double lambda = 0.0;
    while (++iterations <= kMaxIterations) {
        Motion z, r;
        active.split(row.a, z, r);
        const double z2 = z.squaredNorm();
        const double full =
            active.size() < 6 && z2 > kIndependent * kIndependent ? (boundOf(row) - row.a.dot(u)) / z2 : kNever;
        double partial = kNever;
        int let_go = -1;
        for (int i = 0; i < active.size(); ++i) {
            if (!(r[i] > 1e-12) || !(active.lambda(i) / r[i] < partial)) continue;
            partial = active.lambda(i) / r[i];
            let_go = i;
        }
        const double t = std::min(full, partial);
        if (t == kNever) return Taken::Infeasible;
        if (full < kNever) u += t * z;
        for (int i = 0; i < active.size(); ++i) active.lambda(i) = std::max(0.0, active.lambda(i) - t * r[i]);
        lambda += t;
        if (t == full) {
            active.tryAdd(row, lambda);
            return Taken::Yes;
        }
        active.drop(let_go);
    }
    return Taken::Capped;
}

/// False if the rows have no common solution.
bool MotionSolver::attempt(const Motion& wanted, bool all, ConstrainedMotion& result) noexcept {
    ActiveSet active;
    result.u = wanted;
    result.iterations = 0;
    result.converged = true;
    startWarm(wanted, active, result.u);
    while (true) {
        const Row* worst = mostViolated(result.u);
        if (worst == nullptr && all) {
            held_count_ = active.size();
            for (int i = 0; i < held_count_; ++i) held_[static_cast<std::size_t>(i)] = active.row(i);
            if (meetsMore(result.u)) worst = mostViolated(result.u);
        }
        if (worst == nullptr) break;
        const Taken taken = takeUp(Row(*worst), active, result.u, result.iterations);
        if (taken == Taken::Infeasible) return false;
        if (taken == Taken::Capped) {
            result.converged = false;
            break;
        }
    }
    result.active = held_count_ = active.size();
    result.held_span = active.span();
    for (int i = 0; i < active.size(); ++i) {
        const Row& row = held_[static_cast<std::size_t>(i)] = active.row(i);
        result.held[static_cast<std::size_t>(i)] = {row.contact, active.lambda(i) * row.gradient / row.length};
    }
    return true;
}

ConstrainedMotion MotionSolver::solve(const Motion& wanted, bool all) noexcept {
    tolerance_ = std::max(kMotionTolerance, 2.0 * kIndependent * wanted.norm());
    relaxed_ = false;
    ConstrainedMotion result;
    bool found = attempt(wanted, all, result);
    const double bend = (result.u - wanted).norm();
    if (!(found && result.converged && bend <= wanted.norm())) {
        double deepest = 0.0;  // what standing still would leave to be removed
        for (const ContactPoint& contact : around_.contacts) deepest = std::max(deepest, least(contact));
        if (deepest > 0.0 && !(found && result.converged && bend <= wanted.norm() + kFarther * deepest)) {
            relaxed_ = result.relaxed = true;
            found = attempt(wanted, all, result);
        }
    }
    if (!found) {  // rounding only: these rows allow u = 0
        result.u.setZero();
        result.active = held_count_ = 0;
        result.converged = false;
    }
    return result;
}

ConstrainedMotion MotionSolver::solve(const Motion& wanted) noexcept { return solve(wanted, true); }

ConstrainedMotion MotionSolver::solveMet(const Motion& wanted) noexcept { return solve(wanted, false); }

ConstrainedMotion constrainMotion(const Motion& wanted, const Surroundings& around,
                                  std::span<const std::uint32_t> likely) noexcept {
    return MotionSolver(around, likely).solve(wanted);
}

}  // namespace passung::tick
