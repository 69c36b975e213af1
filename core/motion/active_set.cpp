#include "core/motion/active_set.h"

#include <algorithm>
#include <limits>

namespace passung::motion {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

/// What of `a` lies in the span, as r = N⁺ a, and what does not, as z = a - N r; by Gram-Schmidt twice.
template <int N>
void ActiveSetOf<N>::split(const Motion& a, Motion& z, Motion& r) const noexcept {
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

template <int N>
bool ActiveSetOf<N>::tryAdd(const MotionRow& row, double lambda) noexcept {
    if (count_ == N) return false;
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
template <int N>
void ActiveSetOf<N>::drop(int which) noexcept {
    const int end = count_;
    count_ = which;
    for (int i = which + 1; i < end; ++i) {
        const MotionRow row = rows_[static_cast<std::size_t>(i)];
        tryAdd(row, lambdas_[static_cast<std::size_t>(i)]);
    }
}

/// λ = (NᵀN)⁻¹ rhs = R⁻¹ R⁻ᵀ rhs.
template <int N>
MotionOf<N> ActiveSetOf<N>::multipliersFor(const Motion& rhs) const noexcept {
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

template <int N>
MotionOf<N> ActiveSetOf<N>::start(const Motion& wanted) noexcept {
    while (count_ > 0) {
        Motion missing = Motion::Zero();
        for (int i = 0; i < count_; ++i) missing[i] = row(i).bound - row(i).a.dot(wanted);
        const Motion lambda = multipliersFor(missing);
        int pulls = 0;
        for (int i = 1; i < count_; ++i)
            if (lambda[i] < lambda[pulls]) pulls = i;
        if (lambda[pulls] < 0.0) {
            drop(pulls);
            continue;
        }
        Motion u = wanted;
        for (int i = 0; i < count_; ++i) {
            lambdas_[static_cast<std::size_t>(i)] = lambda[i];
            u += lambda[i] * row(i).a;
        }
        return u;
    }
    return wanted;
}

template <int N>
typename ActiveSetOf<N>::Taken ActiveSetOf<N>::takeUp(const MotionRow& row, Motion& u, int& iterations,
                                                      int most) noexcept {
    double lambda = 0.0;
    while (++iterations <= most) {
        Motion z, r;
        split(row.a, z, r);
        const double z2 = z.squaredNorm();
        const double full = count_ < N && z2 > kIndependent * kIndependent ? (row.bound - row.a.dot(u)) / z2 : kNever;
        double partial = kNever;
        int let_go = -1;
        for (int i = 0; i < count_; ++i) {
            if (!(r[i] > 1e-12) || !(lambdas_[static_cast<std::size_t>(i)] / r[i] < partial)) continue;
            partial = lambdas_[static_cast<std::size_t>(i)] / r[i];
            let_go = i;
        }
        const double t = std::min(full, partial);
        if (t == kNever) return Taken::Infeasible;
        if (full < kNever) u += t * z;
        for (int i = 0; i < count_; ++i) {
            double& held = lambdas_[static_cast<std::size_t>(i)];
            held = std::max(0.0, held - t * r[i]);
        }
        lambda += t;
        if (t == full) {
            tryAdd(row, lambda);
            return Taken::Yes;
        }
        drop(let_go);
    }
    return Taken::Capped;
}

template class ActiveSetOf<6>;
template class ActiveSetOf<kMostUnknowns>;

}  // namespace passung::motion
