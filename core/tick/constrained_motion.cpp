#include "core/tick/constrained_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace passung::tick {

namespace {

constexpr double kIndependent = 1e-7;  // a unit row is independent if more than this of it is left
constexpr double kFarther = 4.0;       // per removed overlap: a motion that is bent by more has been sent far away

/// The motion's problem with all that stays the same while it is solved.
struct Problem {
    const Motion& wanted;
    const Surroundings& around;
    bool relaxed = false;

    double least(const ContactPoint& contact) const noexcept {
        const double b = std::min(around.keep_out - contact.phi, around.most_out);
        return relaxed || contact.radius > 0.0 ? std::min(b, 0.0) : b;
    }
};

struct Row {
    Motion a = Motion::Zero();  // unit
    double b = 0.0;
    double lambda = 0.0;
    double push_per_lambda = 0.0;  // what of the row is translation
    std::uint32_t contact = 0;
};

/// The most violated contact as a row; false if there is none.
bool mostViolated(const Problem& problem, const Motion& u, Row& row) noexcept {
    const Vec3 dx = u.head<3>();
    const Vec3 dphi = u.tail<3>() / problem.around.metric_radius;
    double violation = std::max(kMotionTolerance, 2.0 * kIndependent * problem.wanted.norm());
    const Vec3 at_origin = dx - dphi.cross(problem.around.p_WO);
    const ContactPoint* worst = nullptr;
    for (const ContactPoint& contact : problem.around.contacts) {
        const Vec3 motion = at_origin + dphi.cross(contact.position);
        const double missing = problem.least(contact) - contact.gradient.dot(motion);
        if (missing > violation && contact.gradient.squaredNorm() > kLeastGradient * kLeastGradient) {
            violation = missing;
            worst = &contact;
        }
    }
    if (worst == nullptr) return false;
    row.a.head<3>() = worst->gradient;
    row.a.tail<3>() = (worst->position - problem.around.p_WO).cross(worst->gradient) / problem.around.metric_radius;
    const double length = row.a.norm();
    row.a /= length;
    row.b = problem.least(*worst) / length;
    row.lambda = 0.0;
    row.push_per_lambda = worst->gradient.norm() / length;
    row.contact = static_cast<std::uint32_t>(worst - problem.around.contacts.begin());
    return true;
}

/// The active rows N = Q R.
class ActiveSet {
public:
    int size() const noexcept { return count_; }
    Row& operator[](int i) noexcept { return rows_[static_cast<std::size_t>(i)]; }
    const Eigen::Matrix<double, 6, 6>& span() const noexcept { return Q_; }

    /// r = N⁺ a and z = a - N r, the latter by Gram-Schmidt twice.
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

    /// @pre `row` is independent of the others, fewer than six.
    void add(const Row& row) noexcept {
        Motion rest = row.a;
        R_.col(count_).setZero();
        for (int pass = 0; pass < 2; ++pass) {
            for (int i = 0; i < count_; ++i) {
                const double along = Q_.col(i).dot(rest);
                R_(i, count_) += along;
                rest -= along * Q_.col(i);
            }
        }
        R_(count_, count_) = rest.norm();
        Q_.col(count_) = rest / R_(count_, count_);
        rows_[static_cast<std::size_t>(count_++)] = row;
    }

    void drop(int which) noexcept {
        const std::array<Row, 6> rows = rows_;
        const int count = count_;
        count_ = 0;
        for (int i = 0; i < count; ++i) {
            if (i != which) add(rows[static_cast<std::size_t>(i)]);
        }
    }

private:
    std::array<Row, 6> rows_;
    Eigen::Matrix<double, 6, 6> Q_ = Eigen::Matrix<double, 6, 6>::Zero(), R_ = Eigen::Matrix<double, 6, 6>::Zero();
    int count_ = 0;
};

enum class Taken { Yes, Infeasible, Capped };

/// Takes `row` up, letting others go where they are in the way.
Taken takeUp(Row row, ActiveSet& active, Motion& u, int& iterations) noexcept {
    while (++iterations <= kMaxIterations) {
        Motion z, r;
        active.split(row.a, z, r);
        const double z2 = z.squaredNorm();
        constexpr double kNever = std::numeric_limits<double>::infinity();
        const double full =
            active.size() < 6 && z2 > kIndependent * kIndependent ? (row.b - row.a.dot(u)) / z2 : kNever;
        double partial = kNever;
        int let_go = -1;
        for (int i = 0; i < active.size(); ++i) {
            if (!(r[i] > 1e-12) || !(active[i].lambda / r[i] < partial)) continue;
            partial = active[i].lambda / r[i];
            let_go = i;
        }
        const double t = std::min(full, partial);
        if (t == kNever) return Taken::Infeasible;
        if (full < kNever) u += t * z;
        for (int i = 0; i < active.size(); ++i) active[i].lambda = std::max(0.0, active[i].lambda - t * r[i]);
        row.lambda += t;
        if (t == full) {
            active.add(row);
            return Taken::Yes;
        }
        active.drop(let_go);
    }
    return Taken::Capped;
}

/// False if the rows have no common solution.
bool solve(const Problem& problem, ConstrainedMotion& result) noexcept {
    ActiveSet active;
    Row row;
    result.u = problem.wanted;
    result.iterations = 0;
    result.converged = true;
    while (mostViolated(problem, result.u, row)) {
        const Taken taken = takeUp(row, active, result.u, result.iterations);
        if (taken == Taken::Infeasible) return false;
        if (taken == Taken::Capped) {
            result.converged = false;
            break;
        }
    }
    result.active = active.size();
    result.held_span = active.span();
    for (int i = 0; i < active.size(); ++i)
        result.held[static_cast<std::size_t>(i)] = {active[i].contact, active[i].lambda * active[i].push_per_lambda};
    return true;
}

}  // namespace

ConstrainedMotion constrainMotion(const Motion& wanted, const Surroundings& around) noexcept {
    Problem problem{wanted, around};
    ConstrainedMotion result;
    double deepest = 0.0;  // what standing still would leave to be removed
    for (const ContactPoint& contact : around.contacts) deepest = std::max(deepest, problem.least(contact));
    bool found = solve(problem, result);
    const double bend = (result.u - wanted).norm();
    if (deepest > 0.0 && !(found && result.converged && bend <= wanted.norm() + kFarther * deepest)) {
        problem.relaxed = result.relaxed = true;
        found = solve(problem, result);
    }
    if (!found) {  // rounding only: these rows allow u = 0
        result.u.setZero();
        result.converged = false;
    }
    return result;
}

}  // namespace passung::tick
