#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "study/session/picture_quality.h"

namespace passung::presenter {

using session::PictureQuality;
using session::QualityFound;

/// Finds how well a window can draw a scene and still give enough pictures a second: from the best quality downwards,
/// each tried on a few real pictures, until one is fast enough or none is left. Smooth edges go first, then shadows,
/// then resolution down to half the window's. Knows no window and no clock.
class QualitySearch {
public:
    static constexpr double kWanted = 25.0;  // pictures a second
    // The loop, its device and the experimenter's window will run beside: a picture may take so much less now.
    static constexpr double kReserve = 1.2;
    static constexpr std::size_t kFirst = 2;  // pictures that do not count: surfaces and shaders are still being made
    static constexpr std::size_t kTried = 5;  // pictures whose median decides

    /// `shadows`: the protocol asks for them.
    explicit QualitySearch(bool shadows);

    /// To be drawn with now; what was found, once it is done.
    const PictureQuality& candidate() const { return candidates_[at_]; }
    /// The next picture with the candidate took so long [s].
    void take(double seconds);
    bool done() const { return done_; }
    /// Pictures a second that the candidate has reached. @pre done()
    double picturesPerSecond() const { return reached_; }

private:
    void judge();

    std::vector<PictureQuality> candidates_;
    std::size_t at_ = 0;
    std::size_t taken_ = 0;        // pictures with the candidate
    std::vector<double> seconds_;  // of those that count
    bool done_ = false;
    double reached_ = 0.0;
};

}  // namespace passung::presenter
