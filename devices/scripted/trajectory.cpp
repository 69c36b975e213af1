#include "devices/scripted/trajectory.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/number_table.h"
#include "core/base/tick_record.h"

namespace passung::scripted {

namespace {

constexpr double kSameTime = 1e-9;  // [s]: a tick is at a row although the two times were rounded differently
constexpr std::uint32_t kMostButtons = (1u << 24) - 1;  // as many as a record holds

/// A whole number from 0 to kMostButtons.
bool readButtons(const std::string& text, std::uint32_t& buttons) {
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), buttons);
    return problem == std::errc() && end == text.data() + text.size() && buttons <= kMostButtons;
}

}  // namespace

Result<Trajectory> Trajectory::read(const std::string& path) {
    auto table = readNumbers(path, {"t_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"});
    if (!table) return table.errors();
    Trajectory trajectory;
    Errors errors;
    const auto problem = [&](std::size_t row, const char* key, double value, const char* requirement) {
        errors.push_back({.message = requirement,
                          .file = path,
                          .line = table->lines[row],
                          .column = 1,
                          .key = key,
                          .value = std::to_string(value)});
    };
    const auto named = std::find(table->columns.begin(), table->columns.end(), "buttons");
    const auto column = static_cast<std::size_t>(named - table->columns.begin());
    for (std::size_t i = 0; i < table->rows.size(); ++i) {
        const auto& v = table->rows[i];
        Row row{v[0], {Quat(v[4], v[5], v[6], v[7]), Vec3(v[1], v[2], v[3])}, 0};
        if (named != table->columns.end() && !readButtons(table->texts[i][column], row.buttons))
            errors.push_back({.message = "must be a whole number from 0 to 16777215, bit 0 the first button",
                              .file = path,
                              .line = table->lines[i],
                              .column = 1,
                              .key = "buttons",
                              .value = table->texts[i][column]});
        if (!std::isfinite(row.t) || (i > 0 && !(row.t > trajectory.rows_.back().t))) {
            problem(i, "t_s", row.t, "times must be finite and rise from row to row");
        }
        if (isFinite(row.pose)) {
            if (!isRotation(row.pose.q)) {
                problem(i, "qw", row.pose.q.norm(), "the quaternion's length must be 1 ± 0.001");
            }
            row.pose.q.normalize();
        } else if (i == 0) {
            problem(i, "x_m", row.pose.p.x(), "the first pose must be finite");
        }
        trajectory.rows_.push_back(row);
    }
    if (!errors.empty()) return firstFaults(std::move(errors));
    return trajectory;
}

std::int64_t Trajectory::lastTick() const {
    // A last time of 0.3 s is a little less in binary: the tick still belongs to the run.
    return static_cast<std::int64_t>(std::floor(rows_.back().t * 1000.0 + 1e3 * kSameTime));
}

std::vector<Trajectory::Row>::const_iterator Trajectory::after(std::int64_t tick) const {
    const double t = static_cast<double>(tick) * kTickSeconds;
    return std::upper_bound(rows_.begin(), rows_.end(), t, [](double x, const Row& row) { return x < row.t; });
}

std::uint32_t Trajectory::buttonsAt(std::int64_t tick) const {
    const auto next = after(tick);
    if (next != rows_.end() && next->t - static_cast<double>(tick) * kTickSeconds < kSameTime) return next->buttons;
    return next == rows_.begin() ? rows_.front().buttons : (next - 1)->buttons;
}

Pose Trajectory::at(std::int64_t tick) const {
    const double t = static_cast<double>(tick) * kTickSeconds;
    const auto next = after(tick);
    if (next == rows_.begin()) return rows_.front().pose;
    if (next == rows_.end()) return rows_.back().pose;
    const Row& a = *(next - 1);
    const Row& b = *next;
    if (t - a.t < kSameTime) return a.pose;
    if (b.t - t < kSameTime) return b.pose;
    if (!isFinite(a.pose) || !isFinite(b.pose)) {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        return {Quat(nan, nan, nan, nan), Vec3::Constant(nan)};
    }
    const double share = (t - a.t) / (b.t - a.t);
    return {a.pose.q.slerp(share, b.pose.q), a.pose.p + share * (b.pose.p - a.pose.p)};
}

}  // namespace passung::scripted
