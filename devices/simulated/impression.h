#pragma once

#include "devices/simulated/hand_params.h"

namespace passung::simulated {

inline constexpr double kShakes = 2.0;  // [Hz] of pressing and shaking for viscosity and inertia; proposed here

/// What an interval feels like, from nothing but where the hand was and what it felt there, tick by tick.
///   stiffness  slope of the force over the way into the target while it is pressed
///   roughness  root mean square of the force's changes from tick to tick while it is pressed
///   force      length of the mean force, after kSettling
///   viscosity  c of pressing in waves: with x and F the parts of way and force at kShakes, F = (-k - iωc) x
///   inertia    m of shaking: F = mω² x; of whole waves alone, without the first one, in which arm and tool swing in
///   position   way down to where something was touched, put in by touch()
/// Frame: the target's, +z out of it, way and position from where the target was touched or the shaking began.
/// rt-safe.
class Impression {
public:
    explicit Impression(Quantity quantity) noexcept : quantity_(quantity) {}

    void clear() noexcept { *this = Impression(quantity_); }
    void learn(const Vec3& p, const Vec3& force) noexcept;
    void touch(double way) noexcept { value_ = way; }
    /// [N/m], [N], [N·s/m], [kg], [m]; nothing felt is 0.
    double value() const noexcept;

private:
    /// Sums over a wave: of way and force times cosine and sine.
    struct Wave {
        double x_cos = 0.0, x_sin = 0.0, f_cos = 0.0, f_sin = 0.0;
    };

    void learnContact(double depth, const Vec3& force) noexcept;
    void learnWave(double x, double force) noexcept;
    double slope() const noexcept;
    double answerOfWaves() const noexcept;

    Quantity quantity_;
    std::int64_t ticks_ = 0;
    double count_ = 0.0, way_ = 0.0, force_ = 0.0, way_way_ = 0.0, way_force_ = 0.0;
    double changes_ = 0.0, change_square_ = 0.0;
    Vec3 last_force_ = Vec3::Zero(), force_sum_ = Vec3::Zero();
    Wave running_, whole_;  // the wave that is under way, the sum of those before
    double value_ = 0.0;
};

}  // namespace passung::simulated
