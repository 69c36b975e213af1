#include "core/tick/hand_balance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/tick/hand_state.h"
#include "core/tick/tick_model.h"

namespace passung::tick {

namespace {

constexpr int kMostTaken = 200;         // contacts taken up or let go in a balance
constexpr double kRowTolerance = 1e-9;  // [m], of a constraint
constexpr double kFarthestWays = 2.0;   // contacts are looked at within so many of all hands' ways together

using Motions = motion::MotionOf<motion::kMostUnknowns>;
using Row = motion::MotionRowOf<motion::kMostUnknowns>;
using Active = motion::ActiveSetOf<motion::kMostUnknowns>;

auto blockOf(auto& motions, std::size_t hand) { return motions.template segment<6>(6 * static_cast<int>(hand)); }

/// What one hand's search says of a contact.
struct Found {
    std::uint32_t obstacle;
    Vec3 point, normal;
    double room;  // to go before it holds [m]
};

/// Calls `take` with each contact that the hand's last turn left.
template <class Take>
void eachContact(const HandModel& model, const HandState& state, Take take) noexcept {
    if (model.hasClosedForm()) {
        const closed_form::PoseSolver& solver = state.solver;
        for (std::size_t i = 0; i < solver.foundCount(state.X_WG); ++i) {
            const closed_form::HeldContact& held = solver.found(i);
            take(Found{held.pair, held.contact.point, held.contact.normal, held.contact.gap});
        }
    } else if (model.hasSurfaces()) {
        const surface::SurfaceProxy& surface = *state.surface;
        for (const surface::ContactRow& row : surface.rows())
            take(Found{static_cast<std::uint32_t>(obstacleOf(model, surface, row)), surface.pointOf(row),
                       surface.normalOf(row), surface.roomOf(row)});
    } else if (model.hasFieldProxy()) {
        for (const contact::ContactPoint& contact : state.manifold)
            take(Found{contact.obstacle, contact.position, contact.gradient, contact.phi + model.margins.keep});
    }
}

/// Who is in the balance.
bool isBalanced(const HandModel& model, const HandState& state) noexcept {
    return model.hasProxy() && !model.follows && model.contact.method != scene::ContactMethod::Penalty && state.engaged;
}

/// Hands, and what lies between them.
class HandBalance {
public:
    HandBalance(std::span<const HandInTick> hands, std::span<const Pose> X_WH, BalanceMemory& memory) noexcept
        : hands_(hands), memory_(memory) {
        for (std::size_t h = 0; h < hands.size(); ++h) {
            if (!isBalanced(h)) continue;
            blockOf(wanted_, h) = scaleOf(h) * wantedOf(h, X_WH[h]);
            way_ += reachOf(h, wanted_);
        }
        collect();
    }

    /// False: nothing between two hands is near.
    bool hasAny() const noexcept { return between_; }

    /// False: there is no balance, or nothing between two hands holds it.
    bool solve() noexcept {
        if (!attempt()) {
            for (BalancedContact& contact : contacts()) contact.row.bound = std::min(contact.row.bound, 0.0);
            if (!attempt()) return false;
        }
        for (int i = 0; i < active_.size(); ++i)
            if (contactOf(i).other != BalancedContact::kNobody) return true;
        return false;
    }

    int holding() const noexcept { return active_.size(); }
    const BalancedContact& contactOf(int i) const noexcept { return memory_.contacts[active_.row(i).contact]; }
    /// λ of the header [m].
    double pushOf(int i) const noexcept { return active_.lambda(i) / active_.row(i).length; }
    motion::Motion motionOf(std::size_t hand) const noexcept { return blockOf(u_, hand) / scaleOf(hand); }
    /// How far holding contact `i` lets the part in `hand` give way, times its force.
    double givesWay(int i, std::size_t hand) const noexcept {
        return active_.lambda(i) * blockOf(active_.row(i).a, hand).dot(blockOf(u_, hand));
    }

private:
    std::span<BalancedContact> contacts() noexcept { return std::span(memory_.contacts).first(memory_.count); }

    /// Springs of two hands on one part count twice, and so does momentum: its motions times this have the metric of
    /// one spring.
    double scaleOf(std::size_t hand) const noexcept {
        return state(hand).isPulled() ? std::sqrt(state(hand).stiffness) : 1.0;
    }
    motion::Motion wantedOf(std::size_t hand, const Pose& X_WH) const noexcept {
        const HandState& own = state(hand);
        return own.isPulled() ? own.pull.wantedAt(own.metric, own.X_WG) : own.metric.between(own.X_WG, X_WH);
    }
    motion::Motion rowOf(std::size_t hand, const Found& found) const noexcept {
        return state(hand).metric.at(state(hand).X_WG).rowOf(found.point, found.normal) / scaleOf(hand);
    }

    double reachOf(std::size_t hand, const Motions& u) const noexcept {
        return state(hand).metric.wayOf(blockOf(u, hand) / scaleOf(hand), model(hand).reach);
    }

    std::size_t holderOf(std::size_t body) const noexcept {
        for (std::size_t h = 0; h < hands_.size(); ++h)
            if (model(h).body == body && isBalanced(h)) return h;
        return BalancedContact::kNobody;
    }

    void collect() noexcept {
        memory_.count = 0;
        for (std::size_t h = 0; h < hands_.size(); ++h) {
            if (!isBalanced(h)) continue;
            eachContact(model(h), state(h), [&](const Found& found) { add(h, found); });
        }
    }

    void add(std::size_t hand, const Found& found) noexcept {
        if (found.room > kFarthestWays * way_ || memory_.count == memory_.contacts.size()) return;
        const std::size_t body = model(hand).obstacles[found.obstacle].body;
        BalancedContact& contact = memory_.contacts[memory_.count];
        contact = {.row = {},
                   .point = found.point,
                   .normal = found.normal,
                   .hand = hand,
                   .obstacle = found.obstacle,
                   .other = holderOf(body)};
        Row& row = contact.row;
        row.a.setZero();
        blockOf(row.a, hand) = rowOf(hand, found);
        double room = found.room;
        if (contact.other != BalancedContact::kNobody) {
            const std::size_t other = contact.other;
            blockOf(row.a, other) = -rowOf(other, found);
            // The obstacle may have had its turn since.
            const Pose moved = state(other).X_WG * state(hand).X_WO[found.obstacle].inverse();
            room -= found.normal.dot(moved * found.point - found.point);
            between_ = true;
        }
        row.length = row.a.norm();
        if (!(row.length > motion::kLeastGradient)) return;
        row.a /= row.length;
        row.bound = -room / row.length;
        row.contact = static_cast<std::uint32_t>(memory_.count++);
    }

    bool attempt() noexcept {
        active_ = {};
        u_ = wanted_;
        int taken = 0;
        for (;;) {
            const Row* worst = nullptr;
            double most = kRowTolerance;
            for (const BalancedContact& contact : contacts()) {
                const double violated = contact.row.bound - contact.row.a.dot(u_);
                if (violated <= most) continue;
                most = violated;
                worst = &contact.row;
            }
            if (worst == nullptr) return true;
            if (active_.takeUp(*worst, u_, taken, kMostTaken) != Active::Taken::Yes) return false;
        }
    }

    const HandModel& model(std::size_t hand) const noexcept { return *hands_[hand].model; }
    const HandState& state(std::size_t hand) const noexcept { return *hands_[hand].state; }
    bool isBalanced(std::size_t hand) const noexcept { return tick::isBalanced(model(hand), state(hand)); }

    std::span<const HandInTick> hands_;
    BalanceMemory& memory_;
    Motions wanted_ = Motions::Zero(), u_ = Motions::Zero();
    double way_ = 0.0;  // of all hands [m]
    bool between_ = false;
    Active active_;
};

/// K λ n at its point, on the part of `hand`.
void push(const HandInTick& hand, std::size_t obstacle, const Vec3& point, const Vec3& along) noexcept {
    const HandModel& model = *hand.model;
    HandState& state = *hand.state;
    // λ is over one spring's stiffness, a push over that of all that draws the part.
    addPush(model, state, state.X_WG, point, along / state.stiffness, model.contact.stiffness * along.norm(),
            state.from_hands[obstacle]);
    ++state.contacts_of_hands;
}

/// How far the hands have gone since the tick before, as each is told of the others.
void tellWays(std::span<const HandInTick> hands, std::span<const Pose> X_WH) noexcept {
    std::array<double, scene::kMostHands> way{};
    double all = 0.0;
    for (std::size_t h = 0; h < hands.size(); ++h) {
        Pose& before = hands[h].state->X_WH_before;
        const Pose& now = X_WH[h];
        if (!hands[h].model->hasPart() || hands[h].model->follows) continue;
        way[h] =
            (now.p - before.p).norm() + hands[h].model->reach * rotationVector(now.q * before.q.conjugate()).norm();
        all += way[h];
        before = now;
    }
    for (std::size_t h = 0; h < hands.size(); ++h) hands[h].state->others_way = std::max(0.0, all - way[h]);
}

void forget(HeldTarget& target) noexcept {
    target.from_hands.clear();
    target.contacts_of_hands = 0;
    target.balanced = false;
}

}  // namespace

Turns balanceHands(std::span<const HandInTick> hands, std::span<const Pose> X_WH, std::size_t first,
                   BalanceMemory& memory) noexcept {
    const std::size_t count = hands.size();
    Turns turns{};
    for (std::size_t i = 0; i < count; ++i) {
        turns[i] = (first + i) % count;
        hands[i].state->X_WT = X_WH[i];
        forget(*hands[i].state);
    }
    if (memory.contacts.empty()) return turns;
    tellWays(hands, X_WH);
    HandBalance balance(hands, X_WH, memory);
    if (!balance.hasAny() || !balance.solve()) return turns;
    std::array<double, scene::kMostHands> gives_way{};
    std::array<bool, scene::kMostHands> touched{};
    for (int i = 0; i < balance.holding(); ++i) {
        const BalancedContact& contact = balance.contactOf(i);
        const Vec3 along = balance.pushOf(i) * contact.normal;
        push(hands[contact.hand], contact.obstacle, contact.point, along);
        if (contact.other == BalancedContact::kNobody) continue;
        gives_way[contact.hand] += balance.givesWay(i, contact.hand);
        const std::size_t obstacle = hands[contact.other].model->obstacleOf(hands[contact.hand].model->body);
        push(hands[contact.other], obstacle, contact.point, -along);
        gives_way[contact.other] += balance.givesWay(i, contact.other);
        touched[contact.hand] = touched[contact.other] = true;
    }
    for (std::size_t h = 0; h < count; ++h)
        if (touched[h]) {
            hands[h].state->X_WT = hands[h].state->metric.moved(hands[h].state->X_WG, balance.motionOf(h));
            hands[h].state->balanced = true;
        } else {
            forget(*hands[h].state);
        }
    for (std::size_t i = 1; i < count; ++i)
        for (std::size_t k = i; k > 0 && gives_way[turns[k]] > gives_way[turns[k - 1]]; --k)
            std::swap(turns[k], turns[k - 1]);
    return turns;
}

BalanceMemory balanceMemory(const TickModel& model) {
    BalanceMemory memory;
    const auto meets = [](const HandModel& hand) {
        return hand.meetsHands() && hand.hasProxy() && hand.contact.method != scene::ContactMethod::Penalty;
    };
    bool any = std::any_of(model.hands.begin(), model.hands.end(), meets);
    for (const auto& of_hand : model.carrying) any = any || std::any_of(of_hand.begin(), of_hand.end(), meets);
    if (any) memory.contacts.resize(kMostBalanced);
    return memory;
}

}  // namespace passung::tick
