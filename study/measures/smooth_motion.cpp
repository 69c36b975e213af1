#include "study/measures/smooth_motion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "study/measures/period_clock.h"
#include "study/measures/tick_facts.h"

namespace passung::measures {
namespace {

constexpr double kRate = 1000.0;  // [Hz]
using std::numbers::pi;

/// A pass over the series, from the steady state of its first value.
void filterForward(std::vector<double>& series, double bandwidth) {
    const double k = std::tan(pi * bandwidth / kRate), d = 1.0 + std::numbers::sqrt2 * k + k * k;
    const double b = k * k / d, a1 = 2.0 * (k * k - 1.0) / d, a2 = (1.0 - std::numbers::sqrt2 * k + k * k) / d;
    double x1 = series.front(), x2 = x1, y1 = x1, y2 = x1;
    for (double& x : series) {
        const double y = b * x + 2.0 * b * x1 + b * x2 - a1 * y1 - a2 * y2;
        x2 = x1, x1 = x, y2 = y1, y1 = y;
        x = y;
    }
}

Vec3 between(const Vec3& a, const Vec3& b, double share) { return a + share * (b - a); }

/// One component of all periods through the filter; `of` gives a reference to it.
template <class Values, class Of>
void filterComponent(Values& values, double bandwidth, Of of) {
    std::vector<double> series;
    series.reserve(values.size());
    for (auto& value : values) series.push_back(of(value));
    lowPass(series, bandwidth);
    for (std::size_t i = 0; i < values.size(); ++i) of(values[i]) = series[i];
}

/// Amplitudes of the series, padded with zeros to `size`, at k fs / size for k below `count`. The series is taken apart
/// into kParts of every kParts-th value: the whole transform of a long trial would need hundreds of megabytes.
std::vector<double> amplitudes(std::span<const double> series, std::size_t size, std::size_t count) {
    constexpr std::size_t kParts = 64;
    const std::size_t part_size = size / kParts;
    Eigen::FFT<double> transform;
    std::vector<std::complex<double>> sum(count), part, spectrum;
    for (std::size_t first = 0; first < std::min(kParts, series.size()); ++first) {
        part.assign(part_size, 0.0);
        for (std::size_t i = first, to = 0; i < series.size(); i += kParts) part[to++] = series[i];
        transform.fwd(spectrum, part);
        const double turn = -2.0 * pi * static_cast<double>(first) / static_cast<double>(size);
        for (std::size_t k = 0; k < count; ++k) sum[k] += std::polar(1.0, turn * static_cast<double>(k)) * spectrum[k];
    }
    std::vector<double> all;
    all.reserve(count);
    for (const auto& value : sum) all.push_back(std::abs(value));
    return all;
}

}  // namespace

void lowPass(std::vector<double>& series, double bandwidth) {
    if (series.size() < 2) return;
    const auto pad = std::min(series.size() - 1, static_cast<std::size_t>(std::lround(3.0 * kRate / bandwidth)));
    const double first = series.front(), last = series.back();
    std::vector<double> longer;
    longer.reserve(series.size() + 2 * pad);
    for (std::size_t i = pad; i > 0; --i) longer.push_back(2.0 * first - series[i]);
    longer.insert(longer.end(), series.begin(), series.end());
    for (std::size_t i = 1; i <= pad; ++i) longer.push_back(2.0 * last - series[series.size() - 1 - i]);
    for (int pass = 0; pass < 2; ++pass) {
        filterForward(longer, bandwidth);
        std::reverse(longer.begin(), longer.end());
    }
    std::copy_n(longer.begin() + static_cast<std::ptrdiff_t>(pad), series.size(), series.begin());
}

SmoothMotion smoothMotion(std::span<const TickRecord> records, double bandwidth) {
    SmoothMotion motion;
    PeriodClock clock(records.empty() ? 0 : records.front().tick);
    for (const TickRecord& record : records) {
        const auto period = static_cast<std::size_t>(clock.at(record));
        const Vec3 position = handPosition(record);
        Quat turn = handPose(record).q;
        const std::size_t known = motion.positions.size();
        if (known > 0 && motion.turns.back().dot(turn) < 0.0)
            turn.coeffs() *= -1.0;  // the same turn, not the other way
        const Vec3 from = known > 0 ? motion.positions.back() : position;
        const Quat::Coefficients turned = known > 0 ? motion.turns.back().coeffs() : turn.coeffs();
        for (std::size_t i = known; i <= period; ++i) {
            const double share = static_cast<double>(i + 1 - known) / static_cast<double>(period + 1 - known);
            motion.positions.push_back(between(from, position, share));
            motion.turns.emplace_back(Quat::Coefficients(turned + share * (turn.coeffs() - turned)));
        }
        motion.at.push_back(period);
    }
    const std::vector<Vec3> recorded = motion.positions;
    for (int axis = 0; axis < 3; ++axis)
        filterComponent(motion.positions, bandwidth, [axis](Vec3& p) -> double& { return p[axis]; });
    for (int part = 0; part < 4; ++part)
        filterComponent(motion.turns, bandwidth, [part](Quat& q) -> double& { return q.coeffs()[part]; });
    for (Quat& turn : motion.turns) turn.normalize();
    for (std::size_t i = 0; i < recorded.size(); ++i)
        motion.rest_variance +=
            (recorded[i] - motion.positions[i]).squaredNorm() / static_cast<double>(recorded.size());
    return motion;
}

std::vector<double> SmoothMotion::speeds() const {
    std::vector<double> all;
    for (std::size_t i = 1; i < positions.size(); ++i) all.push_back((positions[i] - positions[i - 1]).norm() * kRate);
    return all;
}

double SmoothMotion::jerkSquared() const {
    double sum = 0.0;
    for (std::size_t i = 3; i < positions.size(); ++i)
        sum += (positions[i] - 3.0 * positions[i - 1] + 3.0 * positions[i - 2] - positions[i - 3]).squaredNorm();
    return sum * std::pow(kRate, 5);
}

double SmoothMotion::duration() const {
    return positions.empty() ? 0.0 : static_cast<double>(positions.size() - 1) / kRate;
}

double jerkOfNoise(double bandwidth) {
    const double integral = std::tgamma(1.75) * std::tgamma(0.25) / 4.0;
    return 2.0 * std::pow(2.0 * pi, 6) * std::pow(bandwidth, 7) / kRate * integral;
}

double spectralArcLength(std::span<const double> speeds) {
    constexpr double kHighest = 10.0;  // [Hz]
    constexpr double kLeast = 0.05;    // of the largest amplitude
    if (speeds.size() < 4) return std::numeric_limits<double>::quiet_NaN();
    const std::size_t size = 16 * std::bit_ceil(speeds.size());
    const auto count = static_cast<std::size_t>(kHighest * static_cast<double>(size) / kRate) + 1;
    std::vector<double> spectrum = amplitudes(speeds, size, count);
    // A speed is nowhere negative: its amplitude is largest at rest.
    const double largest = spectrum.front();
    const auto is_in = [&](double amplitude) { return amplitude >= kLeast * largest; };
    const auto end = std::find_if(spectrum.rbegin(), spectrum.rend(), is_in).base();
    const auto steps = static_cast<double>(end - spectrum.begin() - 1);
    double length = 0.0;
    for (auto next = spectrum.begin() + 1; next < end; ++next)
        length += std::hypot(1.0 / steps, (*next - *(next - 1)) / largest);
    return -length;
}

}  // namespace passung::measures
