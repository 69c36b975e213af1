#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace passung::design {

enum class AdaptiveMethod {
    UpDown,  // one step up after a wrong answer, one down after `down_after` right ones in a row (Levitt 1971); steps
             // of different size weigh the answers (Kaernbach 1991)
    Psi,     // grid posterior of threshold and spread, the level of least expected entropy (Kontsevich, Tyler 1999)
};

/// How the levels of one track are chosen. A higher level is easier: the chance of a right answer grows with it.
struct AdaptiveParams {
    AdaptiveMethod method = AdaptiveMethod::UpDown;
    int down_after = 2;            // UpDown: see target()
    double start = 0.0;            // first level
    double low = 0.0, high = 0.0;  // clamp, low < high; with a list, its ends
    double step_down = 0.0;        // > 0, in levels or, logarithmic, in decades
    double step_up = 0.0;          // > 0
    double late_factor = 1.0;      // steps times this after late_after reversals; 0 < factor ≤ 1
    int late_after = 2;
    bool logarithmic = false;         // low > 0
    std::vector<double> levels = {};  // ascending; if not empty, what is presented is the nearest of these
    int max_trials = 40;              // stop at whichever comes first
    int max_reversals = 0;            // 0: no such stop
    int skip_reversals = 2;           // first ones left out of the estimate
    // Psi only
    double guess = 0.5, lapse = 0.02;          // chance of a right answer far below, of a wrong one far above
    double sigma_low = 0.0, sigma_high = 0.0;  // of the normal ogive, in levels or decades
    int grid = 41;                             // points of each axis

    /// The chance of a right answer that UpDown settles at: p^down_after = up / (up + down); Psi: the ogive's middle.
    double target() const;
    /// What is wrong, as sentences.
    std::vector<std::string> validate() const;
};

/// One track: asked for a level, told the answer at the level that was really presented.
class AdaptiveTrack {
public:
    explicit AdaptiveTrack(AdaptiveParams params);  // @pre params.validate() is empty

    /// The level to present next: the wanted one, or with a list the nearest of it. @pre not finished()
    double nextLevel() const;
    /// Before it is rounded to a list. @pre not finished()
    double wantedLevel() const;
    /// `presented` may differ from nextLevel(): it is what counts. Returns true if the direction turned.
    bool answer(double presented, bool right);

    bool finished() const;
    int trials() const { return trials_; }
    int reversals() const { return static_cast<int>(reversal_levels_.size()); }
    /// Threshold at the method's target: the mean of the later reversals, or where Psi's posterior of the ogive's
    /// middle is highest. Not its mean: chance right answers far below the threshold leave a tail towards low
    /// thresholds with wide spreads, which pulls the mean down (by 12 % of sigma after 60 trials with guess 0.5).
    /// Nothing as long as there is nothing to average.
    std::optional<double> estimate() const;
    /// Psi: posterior standard deviation of the threshold, on the axis of its grid; nothing of UpDown.
    std::optional<double> uncertainty() const;

private:
    double onAxis(double level) const;
    double fromAxis(double x) const;
    bool answerByStep(double presented, bool right);
    void answerByPosterior(double x, bool right);
    std::size_t leastEntropy() const;
    double chance(double x, std::size_t alpha, std::size_t sigma) const;
    std::vector<double> thresholdPosterior() const;
    double posteriorMode() const;

    AdaptiveParams params_;
    std::vector<double> candidates_;                   // levels on the axis
    std::vector<double> alphas_, sigmas_, posterior_;  // posterior: sigma varies fastest
    std::vector<double> right_, told_;                 // of each candidate at each point of the posterior
    double level_;                                     // on the axis
    int trials_ = 0, run_ = 0, direction_ = 0;         // direction: of the last step, +1 up
    std::vector<double> reversal_levels_;              // on the axis
};

}  // namespace passung::design
