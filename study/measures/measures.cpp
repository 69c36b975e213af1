#include "study/measures/measures.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "study/measures/detection.h"
#include "study/measures/motion_measures.h"
#include "study/measures/overlap.h"
#include "study/measures/period_clock.h"
#include "study/measures/tick_facts.h"
#include "study/measures/trial.h"
#include "study/measures/type_measures.h"

namespace passung::measures {
namespace {

constexpr const char* kWhatDepthIs =
    "; with contact.geometry = field depth is that of the held part's sample points, which lie about "
    "contact.spacing_mm "
    "apart: an obstacle's edge between two of them reaches deeper than it says; with closed_form it is exact; with "
    "surface it is 0 at the proxy, and at the hand the largest way from the proxy to the hand along a contact's normal";

constexpr const char* kSmooth =
    "; x, q: hand position and quaternion at every period of the trial, missing ones by straight lines, through a "
    "Butterworth low-pass of 2nd order, forward and backward, from rest on a series that goes on as its point "
    "reflection "
    "at both ends; bandwidth: task.motion_bandwidth_hz, 10 Hz where the protocol says nothing";

double magnitude(const std::array<float, 3>& vector) { return Vec3(vector[0], vector[1], vector[2]).norm(); }

double forceOf(const TickRecord& record) { return magnitude(record.force_N); }
double torqueOf(const TickRecord& record) { return magnitude(record.torque_Nm); }
double handDepthOf(const TickRecord& record) { return record.hand_depth_m; }
double proxyDepthOf(const TickRecord& record) { return record.proxy_depth_m; }

HandTicks cutTicks(std::span<const TickRecord> records, const TrialContext& context) {
    const auto firstFrom = [records](std::int64_t tick) {
        return std::partition_point(records.begin(), records.end(),
                                    [tick](const TickRecord& r) { return r.tick < tick; });
    };
    const auto begin = firstFrom(context.start_tick);
    const auto end = std::max(begin, firstFrom(context.end_tick));
    const auto point_end = std::max(end, firstFrom(context.end_tick + 1));
    return {{begin, end}, {begin, point_end}};
}

double wayFromStart(const HandTicks& hand, const TickRecord& record) {
    return (handPosition(record) - handPosition(hand.ticks.front())).norm();
}

Trial cutTrial(std::span<const TickRecord> records, const TrialContext& context,
               std::span<const std::span<const TickRecord>> hands) {
    const HandTicks judged = cutTicks(records, context);
    Trial trial{context, judged.ticks, judged.points, {}, {}, togetherAt(judged.ticks, hands), 0, {}, {}, {}};
    for (const auto& hand : hands) trial.hands.push_back(cutTicks(hand, context));
    if (hands.empty()) trial.hands.push_back(judged);
    for (const HandTicks& hand : trial.hands)
        trial.motions.push_back(smoothMotion(hand.points, context.motion_bandwidth));
    PeriodClock clock(context.start_tick);
    const Pose X_TW = context.X_WT.inverse();
    const bool bore = std::holds_alternative<std::monostate>(context.form);
    std::vector<std::size_t> at(trial.hands.size(), 0);  // of each hand's ticks
    for (std::size_t i = 0; i < trial.ticks.size(); ++i) {
        const TickRecord& record = trial.ticks[i];
        const std::int64_t time = clock.at(record);
        for (std::size_t hand = 0; hand < at.size() && !trial.leave; ++hand) {
            const HandTicks& of_hand = trial.hands[hand];
            for (; at[hand] < of_hand.ticks.size() && of_hand.ticks[at[hand]].tick <= record.tick; ++at[hand])
                if (wayFromStart(of_hand, of_hand.ticks[at[hand]]) > context.leave_radius) trial.leave = time;
        }
        if (!trial.touch && trial.together[i].contact) trial.touch = time;
        if (bore && !trial.engagement && tipDepthInBore(record, X_TW, context.clearance) >= context.engagement_depth)
            trial.engagement = time;
    }
    for (const TickRecord& record : trial.points.subspan(trial.ticks.size())) clock.at(record);
    trial.end = clock.until(context.end_tick);
    return trial;
}

/// First contact, or engagement where the part went in without touching anything before.
std::optional<std::int64_t> approachEnd(const Trial& trial) {
    if (!trial.engagement) return trial.touch;
    return std::min(trial.touch.value_or(*trial.engagement), *trial.engagement);
}

/// A tick counts once, whatever hands.
template <class Quantity>
Optional sumOverTicks(const Trial& trial, Quantity quantity) {
    if (trial.ticks.empty()) return std::nullopt;
    double sum = 0.0;
    for (const TickOfHands& tick : trial.together) sum += quantity(tick);
    return sum;
}

template <double (*quantity)(const TickRecord&)>
Optional meanInContact(const Trial& trial) {
    double sum = 0.0;
    std::int64_t count = 0;
    for (const HandTicks& hand : trial.hands) {
        for (const TickRecord& record : hand.ticks) {
            if (!isContact(record)) continue;
            sum += quantity(record);
            ++count;
        }
    }
    if (count == 0) return std::nullopt;
    return sum / static_cast<double>(count);
}

/// Nearest rank.
template <double (*quantity)(const TickRecord&)>
Optional percentile99InContact(const Trial& trial) {
    std::vector<double> values;
    for (const HandTicks& hand : trial.hands)
        for (const TickRecord& record : hand.ticks)
            if (isContact(record)) values.push_back(quantity(record));
    if (values.empty()) return std::nullopt;
    const std::size_t rank = (99 * values.size() + 99) / 100;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

template <double (*quantity)(const TickRecord&)>
Optional largest(const Trial& trial) {
    if (trial.ticks.empty()) return std::nullopt;
    double result = 0.0;
    for (const HandTicks& hand : trial.hands)
        for (const TickRecord& record : hand.ticks) result = std::max(result, quantity(record));
    return result;
}

Optional leastProxyGap(const Trial& trial) {
    Optional least;
    for (const HandTicks& hand : trial.hands)
        for (const TickRecord& record : hand.ticks)
            if (const double gap = record.proxy_gap_m; std::isfinite(gap)) least = std::min(gap, least.value_or(gap));
    return least;
}

Optional maxExactOverlap(const Trial& trial) {
    Optional most;
    double bound = 0.0;
    for (const TickOverlap& tick : trial.context.overlaps) {
        most = std::max(tick.depth, most.value_or(0.0));
        bound = std::max(bound, tick.bound);
    }
    if (most && bound > *most + kOverlapLeftOpen + kOverlapShareLeftOpen * *most) return std::nullopt;
    return most;
}

Optional exactOverlapShare(const Trial& trial) {
    std::int64_t judged = 0, overlapping = 0;
    for (const TickOverlap& tick : trial.context.overlaps) {
        const bool overlaps = tick.depth > kLeastOverlap;
        if (!tick.every_20th || (!overlaps && tick.bound > kOverlapLeftOpen)) continue;
        ++judged;
        if (overlaps) ++overlapping;
    }
    if (judged == 0) return std::nullopt;
    return static_cast<double>(overlapping) / static_cast<double>(judged);
}

Optional success(const Trial& trial) { return trial.succeeded() ? 1.0 : 0.0; }

Optional completionTime(const Trial& trial) {
    if (!trial.succeeded() || !trial.leave) return std::nullopt;
    return seconds(*trial.leave, trial.end);
}

Optional trialTime(const Trial& trial) {
    if (trial.context.end_tick < trial.context.start_tick) return std::nullopt;
    return seconds(0, trial.end);
}

Optional finished(const Trial& trial) {
    if (!trialTime(trial)) return std::nullopt;
    return success(trial);
}

Optional approachTime(const Trial& trial) {
    const auto end = approachEnd(trial);
    if (!end) return std::nullopt;
    return seconds(0, *end);
}

Optional searchTime(const Trial& trial) {
    if (!trial.engagement) return std::nullopt;
    return seconds(*approachEnd(trial), *trial.engagement);
}

Optional insertionTime(const Trial& trial) {
    if (!trial.succeeded() || !trial.engagement) return std::nullopt;
    return seconds(*trial.engagement, trial.end);
}

Optional insertionDepth(const Trial& trial) {
    if (trial.points.empty() || !std::holds_alternative<std::monostate>(trial.context.form)) return std::nullopt;
    const Pose X_TW = trial.context.X_WT.inverse();
    return tipDepthInBore(trial.points.back(), X_TW, trial.context.clearance).value_or(0.0);
}

Optional contactOnsets(const Trial& trial) {
    constexpr std::int64_t kLeastPause = 20;  // [periods]
    if (trial.ticks.empty()) return std::nullopt;
    PeriodClock clock(trial.context.start_tick);
    std::optional<std::int64_t> last;  // period in contact
    double onsets = 0.0;
    for (std::size_t i = 0; i < trial.ticks.size(); ++i) {
        const std::int64_t time = clock.at(trial.ticks[i]);
        if (!trial.together[i].contact) continue;
        if (!last || time - *last > kLeastPause) onsets += 1.0;
        last = time;
    }
    return onsets;
}

/// Periods of the contact ticks that count.
template <class Counts>
Optional secondsInContact(const Trial& trial, Counts counts) {
    if (trial.ticks.empty()) return std::nullopt;
    double periods = 0.0;
    for (std::size_t i = 0; i < trial.ticks.size(); ++i)
        if (trial.together[i].contact && counts(trial.ticks[i])) periods += trial.lengthOf(i);
    return periods / kPeriodsPerSecond;
}

Optional contactTime(const Trial& trial) {
    return secondsInContact(trial, [](const TickRecord&) { return true; });
}

Optional contactTimeOutside(const Trial& trial) {
    if (!std::holds_alternative<std::monostate>(trial.context.form)) return std::nullopt;
    const Pose X_TW = trial.context.X_WT.inverse();
    return secondsInContact(trial, [&](const TickRecord& record) {
        return !tipDepthInBore(record, X_TW, trial.context.clearance).has_value();
    });
}

Optional impulse(const Trial& trial) {
    if (trial.ticks.empty()) return std::nullopt;
    double sum = 0.0;
    for (const HandTicks& hand : trial.hands)
        for (std::size_t i = 0; i < hand.ticks.size(); ++i)
            sum += forceOf(hand.ticks[i]) * kTickSeconds * hand.lengthOf(i);
    return sum;
}

Optional saturatedShare(const Trial& trial) {
    if (trial.ticks.empty()) return std::nullopt;
    const auto saturated = std::count_if(trial.together.begin(), trial.together.end(),
                                         [](const TickOfHands& tick) { return (tick.status & kForceLimited) != 0; });
    return static_cast<double>(saturated) / static_cast<double>(trial.ticks.size());
}

/// How many trial ticks carry a status bit.
template <TickStatus bit>
Optional ticksWith(const Trial& trial) {
    return sumOverTicks(trial, [](const TickOfHands& tick) { return (tick.status & bit) != 0 ? 1.0 : 0.0; });
}

template <TickStatus bit>
Measure countOf(std::string name, std::string label) {
    return {{std::move(name), std::move(label), "1",
             "number of trial ticks with status bit " + std::to_string(std::countr_zero(std::uint32_t{bit}))},
            ticksWith<bit>};
}

// Words shared by the formulas: a trial tick is a recorded tick with start tick ≤ tick < end tick. A contact tick is a
// trial tick with |force| > 1e-6 N or |torque| > 1e-9 N·m or contacts > 0 (tick_facts.h). The tip is the origin of the
// held part's proxy; it is in the bore below the mouth and within the clearance + 0.2 mm (kWallGive) of the axis.
std::vector<Measure> commonMeasures() {
    return {
        {{"success", "Success", "1",
          "1 if the outcome is success, else 0; success: in every tick of the hold time the tip depth is >= success "
          "fraction x insertion depth, the proxy's speed over the last 50 ticks is < the task's largest, and "
          "proxy_depth_m <= 0.2 mm; tip depth: as for the approach time; time: as for the trial time",
          3},
         success},
        {{"completion_time_s", "Completion time", "s",
          "from the first trial tick at which the hand is farther than the leave radius from its position at the start "
          "tick, to the end tick; only for success; time: as for the trial time",
          2},
         completionTime},
        {{"trial_time_s", "Trial time", "s",
          "from the start tick to the end tick; time between two ticks: 1 ms x the sum of the column periods of the "
          "ticks after the first, up to the second (1 each in virtual time, more after missed cycles)",
          2},
         trialTime},
        {{"time_s", "Time to success, or to the end without one", "s",
          "from the start tick to the end tick of every trial that started, however it ended: with finished = 1 the "
          "time "
          "that it took, with finished = 0 a time after which it was not done yet (censored); time: as for the trial "
          "time"},
         trialTime},
        {{"finished", "Whether the time ended in success", "1",
          "1 if the outcome is success, else 0: time_s is censored; empty where the trial never started"},
         finished},
        {{"approach_time_s", "Approach time", "s",
          "from the start tick to the first contact tick, or to the engagement tick if that is earlier; contact tick: "
          "trial tick with |force| > 1e-6 N or |torque| > 1e-9 N m or contacts > 0, of a held part that weighs (status "
          "bit 20) with contacts > 0 alone, or with hand_depth_m > 0 where the "
          "condition displays no force; engagement tick: first trial tick "
          "with a tip depth >= the engagement depth; tip depth: -z of the proxy's origin in the target's frame, "
          "counted only below the mouth and within the radial clearance + 0.2 mm of the bore's axis; time: as for the "
          "trial time",
          3},
         approachTime},
        {{"search_time_s", "Search time", "s",
          "from the end of the approach to the engagement tick; empty without engagement; both as for the approach "
          "time; time: as for the trial time",
          3},
         searchTime},
        {{"insertion_time_s", "Insertion time", "s",
          "from the engagement tick, as for the approach time, to the end tick; only for success; time: as for the "
          "trial time",
          3},
         insertionTime},
        {{"insertion_depth_m", "Insertion depth", "m",
          "tip depth at the last record up to the end tick; 0 above the mouth or farther than the radial clearance + "
          "0.2 mm "
          "from the bore's axis",
          2},
         insertionDepth},
        {{"path_length_m", "Path length of the hand", "m",
          std::string("sum of |x(k+1) - x(k)| over the periods k") + kSmooth, 2},
         pathLength},
        {{"straight_path_ratio", "Path length over the straight distance", "1",
          std::string("path_length_m / |x(end) - x(start)|") + kSmooth},
         straightPathRatio},
        {{"rotation_path_rad", "Rotation path of the hand", "rad",
          std::string("sum over the periods k of the angle between the quaternions q(k) and q(k+1), each <= pi") +
              kSmooth,
          2},
         rotationPath},
        {{"spectral_arc_length", "Smoothness: spectral arc length (SPARC)", "1",
          std::string(
              "minus the length of the curve A(f)/A(0) over f, width of its band 1, A the amplitude spectrum of "
              "the speed |x(k+1) - x(k)| / 1 ms, padded with zeros to 16 times the next power of two; the band "
              "ends at the last frequency up to 10 Hz with A >= 0.05 A(0) (Balasubramanian et al. 2015); -1.40 "
              "of a reach of least jerk in 1 s, less: less smooth; empty without motion") +
              kSmooth},
         spectralArcLength},
        {{"log_dimensionless_jerk", "Smoothness: log dimensionless jerk", "1",
          std::string("-ln(T^3 J / v^2), T the trial time, v the largest speed, J the sum over the periods of "
                      "|third difference of x|^2 / (1 ms)^5 (Hogan and Sternad 2009); -5.32 of a reach of least jerk, "
                      "less: less smooth; empty where J < 20 x 102.5 x B^7 / s^6 x T x V, B: the bandwidth / 1 Hz, V "
                      "the mean of |x - recorded position|^2: then steps of the sensor may be more than a twentieth "
                      "of it. Of a reach of least jerk over 0.1 m in 1 s that is with steps above 65 um") +
              kSmooth},
         logDimensionlessJerk},
        {{"contact_onsets", "Contact onsets", "1",
          "number of contact ticks with no contact tick in the 20 ms before; contact at the start tick counts; time: "
          "as "
          "for the trial time",
          2},
         contactOnsets},
        {{"contact_time_s", "Contact time", "s",
          "sum over the contact ticks k of periods(k+1) x 1 ms, 1 ms where tick k+1 was not recorded", 2},
         contactTime},
        {{"contact_time_outside_s", "Contact time outside the hole", "s",
          "as contact_time_s, over the contact ticks whose tip depth is not in the bore; tip depth: as for the "
          "approach "
          "time"},
         contactTimeOutside},
        {{"mean_force_N", "Mean force", "N", "mean of |force| over the contact ticks; empty without contact"},
         meanInContact<forceOf>},
        {{"peak_force_N", "Peak force", "N", "largest |force| over the trial ticks"}, largest<forceOf>},
        {{"p99_force_N", "Force, 99th percentile", "N",
          "99th percentile, by nearest rank, of |force| over the contact ticks; empty without contact"},
         percentile99InContact<forceOf>},
        {{"mean_torque_Nm", "Mean torque", "N m", "mean of |torque| over the contact ticks; empty without contact"},
         meanInContact<torqueOf>},
        {{"peak_torque_Nm", "Peak torque", "N m", "largest |torque| over the trial ticks"}, largest<torqueOf>},
        {{"p99_torque_Nm", "Torque, 99th percentile", "N m",
          "99th percentile, by nearest rank, of |torque| over the contact ticks; empty without contact"},
         percentile99InContact<torqueOf>},
        {{"mean_hand_depth_m", "Mean depth at the hand's pose", "m",
          std::string("mean of hand_depth_m over the contact ticks; empty without contact") + kWhatDepthIs},
         meanInContact<handDepthOf>},
        {{"max_hand_depth_m", "Largest depth at the hand's pose", "m",
          std::string("largest hand_depth_m over the trial ticks") + kWhatDepthIs},
         largest<handDepthOf>},
        {{"p99_hand_depth_m", "Depth at the hand's pose, 99th percentile", "m",
          std::string(
              "99th percentile, by nearest rank, of hand_depth_m over the contact ticks; empty without contact") +
              kWhatDepthIs},
         percentile99InContact<handDepthOf>},
        {{"mean_proxy_depth_m", "Mean depth at the proxy's pose", "m",
          std::string("mean of proxy_depth_m over the contact ticks; empty without contact") + kWhatDepthIs},
         meanInContact<proxyDepthOf>},
        {{"max_proxy_depth_m", "Largest depth at the proxy's pose", "m",
          std::string("largest proxy_depth_m over the trial ticks") + kWhatDepthIs},
         largest<proxyDepthOf>},
        {{"p99_proxy_depth_m", "Depth at the proxy's pose, 99th percentile", "m",
          std::string(
              "99th percentile, by nearest rank, of proxy_depth_m over the contact ticks; empty without contact") +
              kWhatDepthIs},
         percentile99InContact<proxyDepthOf>},
        {{"min_proxy_gap_m", "Least proven gap at the proxy's pose", "m",
          "least proxy_gap_m over the trial ticks; empty where contact.geometry proves no gap (field)"},
         leastProxyGap},
        {{"max_exact_overlap_m", "Largest true overlap of what was shown", "m",
          "largest overlap_m of exact_overlap.csv over the trial's judged ticks: the depth of the deepest point of "
          "either part's surface in the other at the proxy's pose, by exact geometry after the trial; judged are every "
          "20th contact tick (the first, the 21st ...) and the 20 trial ticks of largest proxy_depth_m and of largest "
          "|force|; empty where none was judged, or where bound_m leaves open more than 3 um and 5 % beyond it"},
         maxExactOverlap},
        {{"exact_overlap_share", "Share of contact ticks with a true overlap", "1",
          "of every 20th contact tick the share with overlap_m of exact_overlap.csv > 2 um; ticks with less whose "
          "bound_m "
          "is above 3 um are left out; empty without one"},
         exactOverlapShare},
        {{"impulse_Ns", "Impulse", "N s",
          "sum over the trial ticks k of |force(k)| x periods(k+1) x 1 ms, 1 ms where tick k+1 was not recorded", 2},
         impulse},
        {{"work_J", "Work of the hand", "J",
          std::string("-sum over the trial ticks k of force(k).(x(k+1) - x(k)) + torque(k).theta(k), theta the "
                      "rotation vector from q(k) to q(k+1) in world axes; positive: the hand put energy into the "
                      "scene") +
              kSmooth,
          2},
         work},
        {{"saturated_share", "Share of ticks at the force limit", "1",
          "trial ticks with status bit 4 (force or torque limited) / trial ticks"},
         saturatedShare},
        countOf<kInputHeld>("input_held_ticks", "Ticks on the last good pose after a bad sample"),
        countOf<kInputRejected>("input_rejected_ticks", "Ticks without usable device input, hence without force"),
        countOf<kDeviceStale>("device_stale_ticks", "Ticks for which the device had nothing new"),
        countOf<kNonFiniteLatched>("latched_ticks", "Ticks without force because a computed one was not finite"),
        countOf<kForceLimited>("force_limited_ticks", "Ticks at the limit of force or torque"),
        countOf<kRateLimited>("rate_limited_ticks", "Ticks at the limit of rising force"),
        countOf<kPassivityActed>("passivity_ticks", "Ticks in which the passivity controller acted"),
        countOf<kSuspended>("suspended_ticks", "Ticks whose work went on in the next one: the proxy lags"),
    };
}

/// What a measure is of several hands; those that are not named are of the trial, or of the first hand's part.
const char* ofHands(std::string_view name) {
    constexpr const char* kSum = "the sum over the hands, each in the world";
    constexpr const char* kLargest = "the largest over the hands";
    constexpr const char* kMean = "the mean over the contact ticks of each hand, all together";
    constexpr const char* kAllContacts = "over the contact ticks of each hand, all together";
    constexpr const char* kAny = "a tick counts once if it counts for any hand";
    static const std::map<std::string_view, const char*> all = {
        {"completion_time_s",
         "from the first trial tick at which any hand is farther than the leave radius from its "
         "own position at the start tick"},
        {"approach_time_s", "a contact tick is one of any hand"},
        {"search_time_s", "a contact tick is one of any hand"},
        {"path_length_m", kSum},
        {"straight_path_ratio", "path_length_m / the sum over the hands of |x(end) - x(start)|, each in the world"},
        {"spectral_arc_length", "the mean over the hands that move"},
        {"log_dimensionless_jerk", "the mean over the hands; empty where it is of one of them"},
        {"rotation_path_rad", kSum},
        {"contact_onsets", "a contact tick is one of any hand"},
        {"contact_time_s", "a contact tick is one of any hand"},
        {"contact_time_outside_s", "a contact tick is one of any hand"},
        {"p99_force_N", kAllContacts},
        {"p99_torque_Nm", kAllContacts},
        {"p99_hand_depth_m", kAllContacts},
        {"p99_proxy_depth_m", kAllContacts},
        {"mean_force_N", kMean},
        {"peak_force_N", kLargest},
        {"mean_torque_Nm", kMean},
        {"peak_torque_Nm", kLargest},
        {"mean_hand_depth_m", kMean},
        {"max_hand_depth_m", kLargest},
        {"mean_proxy_depth_m", kMean},
        {"max_proxy_depth_m", kLargest},
        {"min_proxy_gap_m", "the least over the hands"},
        {"max_exact_overlap_m",
         "the largest over the parts in any hand; a contact tick is one of any hand, "
         "proxy_depth_m and |force| of a tick are the largest over the hands"},
        {"exact_overlap_share", "a contact tick is one of any hand, and the parts in all hands are judged"},
        {"impulse_Ns", kSum},
        {"work_J", kSum},
        {"saturated_share", kAny}};
    if (countsTicks(name)) return kAny;
    const auto found = all.find(name);
    return found == all.end() ? "" : found->second;
}

/// Those of all trials and of pegs in holes, then those of the other types.
const std::vector<Measure>& measures() {
    static const std::vector<Measure> all = [] {
        std::vector<Measure> list = commonMeasures();
        for (const auto& more :
             {passageMeasures(), contourMeasures(), placementMeasures(), pairMeasures(), assemblyMeasures()})
            list.insert(list.end(), more.begin(), more.end());
        for (Measure& measure : list) measure.definition.of_hands = ofHands(measure.definition.name);
        return list;
    }();
    return all;
}

}  // namespace

const char* outcomeName(Outcome outcome) {
    switch (outcome) {
        case Outcome::Success:
            return "success";
        case Outcome::Failure:
            return "failure";
        case Outcome::Timeout:
            return "timeout";
        case Outcome::Aborted:
            break;
    }
    return "aborted";
}

std::optional<Outcome> outcomeNamed(std::string_view name) {
    for (const Outcome outcome : {Outcome::Success, Outcome::Failure, Outcome::Timeout, Outcome::Aborted})
        if (name == outcomeName(outcome)) return outcome;
    return std::nullopt;
}

const std::vector<MeasureDefinition>& definitions() {
    static const std::vector<MeasureDefinition> all = [] {
        std::vector<MeasureDefinition> result;
        for (const Measure& measure : measures()) result.push_back(measure.definition);
        for (const MeasureDefinition& definition : detectionDefinitions()) result.push_back(definition);
        return result;
    }();
    return all;
}

std::string formulaOf(const MeasureDefinition& definition, std::size_t hands) {
    if (hands < 2 || definition.of_hands.empty()) return definition.formula;
    return definition.formula + "; of several hands: " + definition.of_hands;
}

int versionOf(const MeasureDefinition& definition, std::size_t hands) {
    return definition.version + (hands < 2 || definition.of_hands.empty() ? 0 : 1);
}

bool isKnownUnwatched(std::string_view measure) {
    const auto& all = measures();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Measure& m) { return m.definition.name == measure; });
    if (found == all.end()) return true;  // of the secondary task
    return found->compute == success || found->compute == trialTime || found->compute == finished;
}

bool countsTicks(std::string_view measure) { return measure.ends_with("_ticks"); }

std::vector<Value> computeMeasures(std::span<const TickRecord> records, const TrialContext& context,
                                   std::span<const std::span<const TickRecord>> hands) {
    const Trial trial = cutTrial(records, context, hands);
    std::vector<Value> values;
    values.reserve(definitions().size());
    for (const Measure& measure : measures()) {
        const bool known = context.watched || isKnownUnwatched(measure.definition.name);
        Optional value = known ? measure.compute(trial) : std::nullopt;
        if (value && !std::isfinite(*value)) value.reset();
        values.push_back({measure.definition.name, value});
    }
    for (Value& value : detectionValues(context.detections ? &*context.detections : nullptr))
        values.push_back(std::move(value));
    return values;
}

}  // namespace passung::measures
