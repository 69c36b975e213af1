#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/closed_form/thread_search.h"
#include "core/closed_form/touch_search.h"
#include "core/motion/active_set.h"
#include "core/motion/metric.h"

namespace passung::closed_form {

using motion::MotionMatrix;  // here [1/m]

/// Which line meets which lump.
struct TouchName {
    bool of_held = true;  // the line is the held part's
    bool core = false;    // among the cores, not the edges
    std::uint16_t line = 0, lump = 0;

    friend bool operator==(const TouchName&, const TouchName&) = default;
};

/// A contact of the two parts. A motion u of the held part changes its gap by a · u + ½ uᵀ H u + O(u³).
struct Contact {
    TouchName name;
    Touch touch;
    double gap = 0.0;                           // [m]
    Vec3 point = Vec3::Zero();                  // on the line, world [m]
    Vec3 normal = Vec3::Zero();                 // away from the obstacle, world; of a kink not of length 1
    motion::Motion a = motion::Motion::Zero();  // motion::Metric::rowOf
    double lean = 0.0;  // by which the normal leaves those that the line's own edge can have [rad]; 0: a contact
};

/// Contacts of a pair at one pose. Full: an overlap may be unknown.
using PairContacts = FixedList<Contact, 768>;

/// The most that any contact overlaps [m], ≥ 0.
double overlapOf(const PairContacts& contacts) noexcept;

/// A held part against an obstacle.
struct SolidPair {
    const SmoothSolid* held;
    const SmoothSolid* obstacle;
    Pose X_WO;              // of the obstacle
    motion::Metric metric;  // of the held part's motions
};

/// A pair at a pose, with what follows from that for all of its lines.
struct PlacedPair;

/// Memory of a search, for as many as come one after the other: what one leaves in it is nobody's.
struct SearchMemory {
    Touches touches;
    ThreadSamples samples;
};

/// Finds a pair's contacts at one pose after the other. What it knows of a line and a lump that are far from each other
/// saves looks at them until the held part has moved so far that they could touch.
class ContactSearch {
public:
    /// The pair's solids outlive this.
    explicit ContactSearch(const SolidPair& pair);

    const SolidPair& pair() const noexcept { return pair_; }
    /// The obstacle is elsewhere from now on. What is known of lines and lumps is kept: seen from the obstacle the held
    /// part has moved by the inverse. True if it is elsewhere. rt-safe.
    bool place(const Pose& X_WO) noexcept;
    /// The held part is held at another point from now on. rt-safe.
    void measureBy(const motion::Metric& metric) noexcept { pair_.metric = metric; }
    /// Pieces of lines times lumps of the other part that a look may have to look at, threads' apart.
    std::size_t meetings() const noexcept;

    /// All contacts with a gap of at most `reach` and a lean of at most `most_lean`. Returns a way that no point of the
    /// held part has to go before the parts touch [m], proven where it is > 0. rt-safe.
    double find(const Pose& X_WH, double reach, PairContacts& contacts, SearchMemory& memory,
                double most_lean = std::numeric_limits<double>::infinity()) noexcept;
    /// The same with memory of its own, for single looks.
    double find(const Pose& X_WH, double reach, PairContacts& contacts) noexcept;
    /// The most that any contact overlapped there, however it leant [m], ≥ 0.
    double foundOverlap() const noexcept { return overlap_; }

    struct Overlap {
        double depth = 0.0;  // the most that any contact overlaps [m], ≥ 0
        bool full = false;   // more contacts than there is room for: it may be deeper
    };
    /// That of all contacts that find() has at this pose, of which only those are looked for that can be deeper than
    /// what is found already. rt-safe.
    Overlap overlapAt(const Pose& X_WH, SearchMemory& memory) noexcept;
    Overlap overlapAt(const Pose& X_WH) noexcept;

private:
    /// A piece of a line and a lump of the other part.
    struct Meeting {
        TouchName name;
        std::uint16_t piece = 0;
        bool of_thread = false;
        bool touches = true;           // false: of no contact, of the bound alone
        double bound = 0.0;            // of the gap, when it was looked at last [m]
        double reach = 0.0;            // that was looked for then: of a thread a bound says nothing of lower ones [m]
        double lever = 0.0;            // of the line's points about the held part's origin, then [m]
        double way = 0.0, turn = 0.0;  // of the held part, until then
    };

    void addMeetings(bool of_held);
    void moveTo(const Pose& X_WH) noexcept;
    double boundOf(const Meeting& meeting) const noexcept;
    /// `closely`: for a bound that saves more looks than it costs where few are near.
    template <class Take>
    void look(PlacedPair& placed, double reach, bool closely, Meeting& meeting, SearchMemory& memory,
              Take take) noexcept;
    bool isSampled(const Meeting& meeting) const noexcept;

    SolidPair pair_;
    std::vector<Meeting> meetings_;
    std::size_t deepest_ = 0;  // meeting of the last overlap
    Pose X_last_;
    double overlap_ = 0.0;
    const Meeting* sampled_ = nullptr;  // whose line's piece the samples are of, at this pose
    double way_ = 0.0, turn_ = 0.0;     // that the held part has made [m], [rad]
};

/// What the place of a contact that was found at an earlier pose has to obey at this one: the row of the lump's highest
/// face there. Nothing where that is another face than the contact's, so that nothing holds there any more, and for a
/// kink whose normal that face has not: it lay there for a moment only, and its row would hold what is free. rt-safe.
std::optional<Contact> keptAt(const SolidPair& pair, const Pose& X_WH, const Contact& contact) noexcept;

/// H of a contact, as X_WH has it. Where the contact moves along its line as the parts move (`slides`), that is
/// eliminated: of a smooth minimum H - f_tu f_tuᵀ / f_tt, of a kink with the 2 × 2 system of t and the faces' shares.
/// rt-safe.
MotionMatrix curvatureOf(const SolidPair& pair, const Pose& X_WH, const Contact& contact, bool slides) noexcept;

}  // namespace passung::closed_form
