#include "study/design/adaptive.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/assert.h"

namespace passung::design {
namespace {

constexpr std::size_t kSigmas = 11;  // points of the spread's axis, evenly in its logarithm

double normalCdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

double power(double low, double high, std::size_t i, std::size_t n) {
    return low * std::pow(high / low, static_cast<double>(i) / static_cast<double>(n - 1));
}

}  // namespace

double AdaptiveParams::target() const {
    if (method == AdaptiveMethod::Psi) return guess + 0.5 * (1.0 - guess - lapse);
    return std::pow(step_up / (step_up + step_down), 1.0 / down_after);
}

std::vector<std::string> AdaptiveParams::validate() const {
    std::vector<std::string> wrong;
    const auto require = [&](bool holds, const char* sentence) {
        if (!holds) wrong.emplace_back(sentence);
    };
    require(std::isfinite(low) && std::isfinite(high) && low < high, "low must be below high");
    require(start >= low && start <= high, "start must lie from low to high");
    require(!logarithmic || low > 0.0, "logarithmic levels must be > 0");
    require(max_trials >= 1, "max_trials must be at least 1");
    const bool within =
        std::all_of(levels.begin(), levels.end(), [&](double level) { return level >= low && level <= high; });
    require(within && std::is_sorted(levels.begin(), levels.end()), "levels must ascend from low to high");
    if (method == AdaptiveMethod::UpDown) {
        require(down_after >= 1, "down_after must be at least 1");
        require(step_down > 0.0 && step_up > 0.0, "steps must be > 0");
        require(late_factor > 0.0 && late_factor <= 1.0, "late_factor must be > 0 and at most 1");
    } else {
        require(guess >= 0.0 && lapse >= 0.0 && guess + lapse < 1.0, "guess and lapse must leave room for an ogive");
        require(sigma_low > 0.0 && sigma_high > sigma_low, "sigma_low must be > 0 and below sigma_high");
        require(grid >= 3, "grid must be at least 3");
    }
    return wrong;
}

AdaptiveTrack::AdaptiveTrack(AdaptiveParams params) : params_(std::move(params)), level_(onAxis(params_.start)) {
    PASSUNG_ASSERT(params_.validate().empty());
    for (const double level : params_.levels) candidates_.push_back(onAxis(level));
    if (params_.method != AdaptiveMethod::Psi) return;
    const auto n = static_cast<std::size_t>(params_.grid);
    const double low = onAxis(params_.low), high = onAxis(params_.high);
    for (std::size_t i = 0; i < n; ++i)
        alphas_.push_back(low + (high - low) * static_cast<double>(i) / static_cast<double>(n - 1));
    for (std::size_t i = 0; i < kSigmas; ++i)
        sigmas_.push_back(power(params_.sigma_low, params_.sigma_high, i, kSigmas));
    if (candidates_.empty()) candidates_ = alphas_;
    posterior_.assign(n * kSigmas, 1.0 / static_cast<double>(n * kSigmas));
    for (const double x : candidates_) {
        for (std::size_t i = 0; i < n * kSigmas; ++i) {
            const double right = chance(x, i / kSigmas, i % kSigmas), wrong = 1.0 - right;
            right_.push_back(right);
            told_.push_back(right * std::log(std::max(right, 1e-300)) + wrong * std::log(std::max(wrong, 1e-300)));
        }
    }
    level_ = candidates_[leastEntropy()];
}

double AdaptiveTrack::onAxis(double level) const { return params_.logarithmic ? std::log10(level) : level; }
double AdaptiveTrack::fromAxis(double x) const { return params_.logarithmic ? std::pow(10.0, x) : x; }

double AdaptiveTrack::wantedLevel() const {
    PASSUNG_ASSERT(!finished());
    return std::clamp(fromAxis(level_), params_.low, params_.high);
}

double AdaptiveTrack::nextLevel() const {
    PASSUNG_ASSERT(!finished());
    if (params_.levels.empty()) return wantedLevel();
    const auto nearest = std::min_element(candidates_.begin(), candidates_.end(), [&](double a, double b) {
        return std::abs(a - level_) < std::abs(b - level_);
    });
    return params_.levels[static_cast<std::size_t>(nearest - candidates_.begin())];
}

bool AdaptiveTrack::answer(double presented, bool right) {
    PASSUNG_ASSERT(!finished());
    ++trials_;
    if (params_.method == AdaptiveMethod::UpDown) return answerByStep(presented, right);
    answerByPosterior(onAxis(presented), right);
    return false;
}

/// Steps start from what was presented, which need not be what was asked for.
bool AdaptiveTrack::answerByStep(double presented, bool right) {
    const double x = onAxis(presented);
    run_ = right ? run_ + 1 : 0;
    const int direction = !right ? 1 : run_ >= params_.down_after ? -1 : 0;
    if (direction == 0) return false;
    run_ = 0;
    const bool turned = direction_ != 0 && direction != direction_;
    direction_ = direction;
    if (turned) reversal_levels_.push_back(x);
    const double factor = reversals() >= params_.late_after ? params_.late_factor : 1.0;
    const double step = direction > 0 ? params_.step_up : -params_.step_down;
    level_ = std::clamp(x + factor * step, onAxis(params_.low), onAxis(params_.high));
    return turned;
}

double AdaptiveTrack::chance(double x, std::size_t alpha, std::size_t sigma) const {
    const double ogive = normalCdf((x - alphas_[alpha]) / sigmas_[sigma]);
    return params_.guess + (1.0 - params_.guess - params_.lapse) * ogive;
}

void AdaptiveTrack::answerByPosterior(double x, bool right) {
    const auto known = std::find(candidates_.begin(), candidates_.end(), x) - candidates_.begin();
    const std::size_t row = static_cast<std::size_t>(known) * posterior_.size();
    double sum = 0.0;
    for (std::size_t i = 0; i < posterior_.size(); ++i) {
        const double p = row < right_.size() ? right_[row + i] : chance(x, i / kSigmas, i % kSigmas);
        posterior_[i] *= right ? p : 1.0 - p;
        sum += posterior_[i];
    }
    for (double& p : posterior_) p /= sum;
    level_ = candidates_[leastEntropy()];
}

/// The candidate whose answer leaves the least entropy on average. With the posterior q, the chance p of a right answer
/// and n = sum of q p, that entropy is
///   n ln n + (1 - n) ln(1 - n) - sum of q (p ln p + (1 - p) ln(1 - p)) - sum of q ln q,
/// of which the last is the same for all.
std::size_t AdaptiveTrack::leastEntropy() const {
    const double* q = posterior_.data();
    std::size_t best = 0;
    double least = 0.0;
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
        const double* right = right_.data() + c * posterior_.size();
        const double* told_at = told_.data() + c * posterior_.size();
        double n = 0.0, told = 0.0;
        for (std::size_t i = 0; i < posterior_.size(); ++i) {
            n += q[i] * right[i];
            told += q[i] * told_at[i];
        }
        const double entropy =
            n * std::log(std::max(n, 1e-300)) + (1.0 - n) * std::log(std::max(1.0 - n, 1e-300)) - told;
        if (c > 0 && !(entropy < least)) continue;
        best = c;
        least = entropy;
    }
    return best;
}

bool AdaptiveTrack::finished() const {
    return trials_ >= params_.max_trials || (params_.max_reversals > 0 && reversals() >= params_.max_reversals);
}

std::vector<double> AdaptiveTrack::thresholdPosterior() const {
    std::vector<double> shares(alphas_.size());
    for (std::size_t i = 0; i < posterior_.size(); ++i) shares[i / kSigmas] += posterior_[i];
    return shares;
}

/// The top of the parabola through the highest point of the grid and its neighbours.
double AdaptiveTrack::posteriorMode() const {
    const auto shares = thresholdPosterior();
    const auto top = static_cast<std::size_t>(std::max_element(shares.begin(), shares.end()) - shares.begin());
    if (top == 0 || top + 1 == shares.size()) return alphas_[top];
    const double before = shares[top - 1], after = shares[top + 1];
    const double curvature = before - 2.0 * shares[top] + after;
    const double aside = curvature < 0.0 ? 0.5 * (before - after) / curvature : 0.0;
    return alphas_[top] + aside * (alphas_[top + 1] - alphas_[top]);
}

std::optional<double> AdaptiveTrack::estimate() const {
    if (params_.method == AdaptiveMethod::Psi) return fromAxis(posteriorMode());
    const auto skipped = static_cast<std::size_t>(std::max(0, params_.skip_reversals));
    if (reversal_levels_.size() <= skipped) return std::nullopt;
    // An even number: tops and bottoms in equal parts.
    const std::size_t count = (reversal_levels_.size() - skipped) / 2 * 2;
    if (count == 0) return std::nullopt;
    const double sum =
        std::accumulate(reversal_levels_.end() - static_cast<std::ptrdiff_t>(count), reversal_levels_.end(), 0.0);
    return fromAxis(sum / static_cast<double>(count));
}

std::optional<double> AdaptiveTrack::uncertainty() const {
    if (params_.method != AdaptiveMethod::Psi) return std::nullopt;
    const auto shares = thresholdPosterior();
    const double mean = std::inner_product(shares.begin(), shares.end(), alphas_.begin(), 0.0);
    double variance = 0.0;
    for (std::size_t i = 0; i < shares.size(); ++i) variance += shares[i] * (alphas_[i] - mean) * (alphas_[i] - mean);
    return std::sqrt(variance);
}

}  // namespace passung::design
