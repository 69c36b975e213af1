#include "core/tick/hand_balance.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/tick/hand_state.h"

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
    return model.hasProxy() && model.contact.method != scene::ContactMethod::Penalty && state.engaged;
}

/// Hands, and what lies between them.
class HandBalance {
public:
    HandBalance(std::span<const HandModel> models, std::span<const HandState> states, std::span<const Pose> X_WH,
                BalanceMemory& memory) noexcept
        : models_(models), states_(states), memory_(memory) {
        for (std::size_t h = 0; h < models.size(); ++h) {
            if (!isBalanced(models[h], states[h])) continue;
            blockOf(wanted_, h) = states[h].metric.between(states[h].X_WG, X_WH[h]);
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
    motion::Motion motionOf(std::size_t hand) const noexcept { return blockOf(u_, hand); }
    /// How far holding contact `i` lets the part in `hand` give way, times its force.
    double givesWay(int i, std::size_t hand) const noexcept {
        return active_.lambda(i) * blockOf(active_.row(i).a, hand).dot(blockOf(u_, hand));
    }

private:
    std::span<BalancedContact> contacts() noexcept { return std::span(memory_.contacts).first(memory_.count); }

    double reachOf(std::size_t hand, const Motions& u) const noexcept {
        return states_[hand].metric.wayOf(blockOf(u, hand), models_[hand].reach);
    }

    std::size_t holderOf(std::size_t body) const noexcept {
        for (std::size_t h = 0; h < models_.size(); ++h)
            if (models_[h].body == body && isBalanced(models_[h], states_[h])) return h;
        return BalancedContact::kNobody;
    }

    void collect() noexcept {
        memory_.count = 0;
        for (std::size_t h = 0; h < models_.size(); ++h) {
            if (!isBalanced(models_[h], states_[h])) continue;
            eachContact(models_[h], states_[h], [&](const Found& found) { add(h, found); });
        }
    }

    void add(std::size_t hand, const Found& found) noexcept {
        if (found.room > kFarthestWays * way_ || memory_.count == memory_.contacts.size()) return;
        const HandModel& model = models_[hand];
        const std::size_t body = model.obstacles[found.obstacle].body;
        BalancedContact& contact = memory_.contacts[memory_.count];
        contact = {.row = {},
                   .point = found.point,
                   .normal = found.normal,
                   .hand = hand,
                   .obstacle = found.obstacle,
                   .other = holderOf(body)};
        Row& row = contact.row;
        row.a.setZero();
        blockOf(row.a, hand) = states_[hand].metric.rowOf(states_[hand].X_WG, found.point, found.normal);
        double room = found.room;
        if (contact.other != BalancedContact::kNobody) {
            const std::size_t other = contact.other;
            blockOf(row.a, other) = -states_[other].metric.rowOf(states_[other].X_WG, found.point, found.normal);
            // The obstacle may have had its turn since.
            const Pose moved = states_[other].X_WG * states_[hand].X_WO[found.obstacle].inverse();
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

    std::span<const HandModel> models_;
    std::span<const HandState> states_;
    BalanceMemory& memory_;
    Motions wanted_ = Motions::Zero(), u_ = Motions::Zero();
    double way_ = 0.0;  // of all hands [m]
    bool between_ = false;
    Active active_;
};

/// K λ n at its point, on the part of `hand`.
void push(const HandModel& model, HandState& state, std::size_t obstacle, const Vec3& point,
          const Vec3& along) noexcept {
    addPush(model, state, state.X_WG, point, along, model.contact.stiffness * along.norm(), state.from_hands[obstacle]);
    ++state.contacts_of_hands;
}

/// How far the hands have gone since the tick before, as each is told of the others.
void tellWays(std::span<const HandModel> models, std::span<HandState> states, std::span<const Pose> X_WH) noexcept {
    std::array<double, scene::kMostHands> way{};
    double all = 0.0;
    for (std::size_t h = 0; h < models.size(); ++h) {
        const Pose &before = states[h].X_WH_before, &now = X_WH[h];
        way[h] = (now.p - before.p).norm() + models[h].reach * rotationVector(now.q * before.q.conjugate()).norm();
        all += way[h];
        states[h].X_WH_before = now;
    }
    for (std::size_t h = 0; h < models.size(); ++h) states[h].others_way = std::max(0.0, all - way[h]);
}

void forget(HeldTarget& target) noexcept {
    target.from_hands.clear();
    target.contacts_of_hands = 0;
}

}  // namespace

Turns balanceHands(std::span<const HandModel> models, std::span<HandState> states, std::span<const Pose> X_WH,
                   std::size_t first, BalanceMemory& memory) noexcept {
    const std::size_t count = models.size();
    Turns turns{};
    for (std::size_t i = 0; i < count; ++i) {
        turns[i] = (first + i) % count;
        states[i].X_WT = X_WH[i];
        forget(states[i]);
    }
    if (memory.contacts.empty()) return turns;
    tellWays(models, states, X_WH);
    HandBalance balance(models, states, X_WH, memory);
    if (!balance.hasAny() || !balance.solve()) return turns;
    std::array<double, scene::kMostHands> gives_way{};
    std::array<bool, scene::kMostHands> touched{};
    for (int i = 0; i < balance.holding(); ++i) {
        const BalancedContact& contact = balance.contactOf(i);
        const Vec3 along = balance.pushOf(i) * contact.normal;
        push(models[contact.hand], states[contact.hand], contact.obstacle, contact.point, along);
        if (contact.other == BalancedContact::kNobody) continue;
        gives_way[contact.hand] += balance.givesWay(i, contact.hand);
        const std::size_t body = models[contact.hand].body, own = models[contact.other].body;
        push(models[contact.other], states[contact.other], body < own ? body : body - 1, contact.point, -along);
        gives_way[contact.other] += balance.givesWay(i, contact.other);
        touched[contact.hand] = touched[contact.other] = true;
    }
    for (std::size_t h = 0; h < count; ++h)
        if (touched[h])
            states[h].X_WT = states[h].metric.moved(states[h].X_WG, balance.motionOf(h));
        else
            forget(states[h]);
    for (std::size_t i = 1; i < count; ++i)
        for (std::size_t k = i; k > 0 && gives_way[turns[k]] > gives_way[turns[k - 1]]; --k)
            std::swap(turns[k], turns[k - 1]);
    return turns;
}

BalanceMemory balanceMemory(std::span<const HandModel> models) {
    BalanceMemory memory;
    const bool any = std::any_of(models.begin(), models.end(), [](const HandModel& model) {
        return !model.moving.empty() && model.hasProxy() && model.contact.method != scene::ContactMethod::Penalty;
    });
    if (any) memory.contacts.resize(kMostBalanced);
    return memory;
}

}  // namespace passung::tick
