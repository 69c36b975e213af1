#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/tick_record.h"
#include "core/base/types.h"

namespace passung::measures {

/// A hand's motion through a low-pass: what an encoder's steps and a sensor's noise add to single ticks is no motion.
///
/// Series of positions and quaternions at every haptic period, missing ones in between by straight lines, each
/// component through a Butterworth filter of 2nd order, forward and backward, so that nothing is delayed:
///
///   k = tan(pi B / fs),  b = k^2 (1, 2, 1) / d,  a = (2 (k^2 - 1), 1 - sqrt(2) k + k^2) / d,  d = 1 + sqrt(2) k + k^2
///
/// with the bandwidth B, -3 dB in each pass, and fs = 1000 Hz (bilinear transform with prewarping; Oppenheim and
/// Schafer, Discrete-Time Signal Processing). It begins at rest in its first value, on a series that goes on at both
/// ends as its own point reflection, for 3/B. Limits: a line comes through as it is; B towards fs/2: nothing is
/// changed.
struct SmoothMotion {
    std::vector<Vec3> positions;         // [m], at every period
    std::vector<Quat> turns;             // unit
    std::vector<std::size_t> at;         // of each record, its period
    double rest_variance = 0.0;          // mean of the squared way from the filtered to the recorded position [m²]
    std::vector<double> speeds() const;  // [m/s], of each period but the last
    double jerkSquared() const;          // integral of the squared third derivative [m²/s⁵]
    double duration() const;             // [s]
};

/// @pre bandwidth > 0 [Hz], below half the haptic rate
SmoothMotion smoothMotion(std::span<const TickRecord> records, double bandwidth);

/// The filter. @pre as above
void lowPass(std::vector<double>& series, double bandwidth);

/// How much of the squared jerk's integral a second of white noise in the position leaves behind the filter, per
/// variance of the noise: 2 (2 pi)^6 B^7 / fs times the integral of u^6 / (1 + u^4)^2, which is gamma(7/4) gamma(1/4)
/// / 4 [1/s⁶].
double jerkOfNoise(double bandwidth);

/// Spectral arc length of a speed's profile (Balasubramanian, Melendez-Calderon, Roby-Brami and Burdet 2015, J NeuroEng
/// Rehabil 12:112): minus the length of its amplitude spectrum, largest amplitude and width of the band 1, from the
/// first to the last frequency up to 10 Hz with at least 0.05 of the largest amplitude; the profile is padded with
/// zeros to 16 times the next power of two. -1.40 of the smoothest reach, less of any other. NaN: nothing moves.
double spectralArcLength(std::span<const double> speeds);

}  // namespace passung::measures
