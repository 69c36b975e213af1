#pragma once

#include <cstdint>
#include <vector>

#include "core/contact/certificates.h"
#include "core/geometry/near_list.h"
#include "core/tick/hand_model.h"

namespace passung::tick {

/// What earlier looks proved of each obstacle with the held part: of the held part's points, and in two-way contact of
/// the obstacle's. True wherever the held part is, but sharp only near the poses of those looks.
struct PairCertificates {
    contact::ShellCertificates held, obstacle;
};

/// Certificates of a few obstacles: each that is near has its own, as long as there are no more than kMost. A newcomer
/// gets those of an obstacle that the last look did without.
class KnownPairs {
public:
    static constexpr std::size_t kMost = geometry::NearList::kAll;

    KnownPairs() = default;  // no memory
    explicit KnownPairs(const HandModel& model);

    /// A look at some obstacles begins. rt-safe, as below.
    void begin() noexcept { ++look_; }
    /// Of obstacle `i`; null if there are none left.
    PairCertificates* of(const HandModel& model, std::uint32_t i) noexcept;

private:
    static constexpr std::uint32_t kNobody = ~0u;
    struct Slot {
        PairCertificates pair;
        std::uint32_t obstacle = kNobody;
        std::uint64_t look = 0;  // that needed it last
    };
    std::vector<Slot> slots_;
    std::vector<std::uint8_t> slot_of_;  // of each obstacle; kMost: none
    std::uint64_t look_ = 2;             // those that nobody has needed are two behind
};

/// What looks from one place to the next tell of the obstacles.
struct Lookout {
    geometry::NearList near;
    KnownPairs known;
};

/// How near the boxes of Lookout::near have to be for points with φ < `most` [m]. What is read of a field errs by no
/// more than the accuracy that it was built to near its surface, and by a tenth of the distance beyond (FieldAccuracy):
/// a point that is read as φ < r is nearer than 1.25 r and what makes the boxes larger, twice that accuracy. rt-safe.
constexpr double lookReach(double most) noexcept { return 1.25 * (most > 0.0 ? most : 0.0); }

/// Of a model of Geometry::Field, without certificates. Allocates.
Lookout lookoutOf(const HandModel& model);

}  // namespace passung::tick
