#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "devices/simulated/hand.h"

namespace passung::simulated {

/// A hand that picks parts up where it sees them and puts each where it belongs, step by step: it goes to the grip,
/// closes, looks which part it has, carries it over what is around, inserts it as Hand does or puts it down as
/// PlaceHand does, lets it go and looks whether the step is done; else it takes the part again and corrects. What has
/// to be turned farther than the wrist can it puts down on the way, turned as far as it can, and takes it anew. While
/// nothing of its own may be done it waits where it is, or helps: a part that the hand of its step does not reach it
/// fetches, holds still between both, and lets go when the other hand has it.
class AssembleHand final : public Hand {
public:
    /// @pre params.validate() is empty and task.goal is an AssembleGoal.
    AssembleHand(const HandParams& params, const VisibleTask& task, const HandRegistration& registration,
                 std::uint64_t seed);

private:
    enum class Stage {
        ToStart,
        HoldStart,
        Choose,   // what is to be done next
        Over,     // reach to above the grip
        Look,     // where the grip is
        Down,     // reach to the grip
        Steady,   // stand still, correct what friction held back
        Close,    // the button, then look what is in the hand
        Weigh,    // stand still until no other hand has it, look how the part lies in the hand
        TurnUp,   // a little up, turned as far as the wrist can
        LayDown,  // back down, to take it anew
        Lift,     // clear of what is around
        Carry,    // to above the goal
        Give,     // hold it until the other hand has it
        Insert,   // as Hand
        Slide,    // to the depth as seen
        PutDown,  // reach to the goal
        Correct,  // look how far it is off
        Open,     // the button, until the hand is seen empty
        Check,    // look whether the step is done
        Leave,    // up from the part
    };
    using Step = AssembleGoal::Step;
    using Part = AssembleGoal::Part;

    void begin() noexcept override { stage_ = Stage::ToStart; }
    void choose(const Percept& percept) noexcept override;
    void enter(Stage stage) noexcept;
    void reach(Stage stage, const Pose& to, double duration) noexcept;
    bool arrived() noexcept;

    void take(const Percept& percept) noexcept;
    void toStart(const Percept& percept) noexcept;
    void chooseStep(const Percept& percept) noexcept;
    void look(const Percept& percept) noexcept;
    void close(const Percept& percept) noexcept;
    void weigh(const Percept& percept) noexcept;
    Vec3 wristTurn() const noexcept;
    void turnOnTheWay() noexcept;
    void setOut() noexcept;
    void carry() noexcept;
    void give(const Percept& percept) noexcept;
    void bring() noexcept;
    void insert(const Percept& percept) noexcept;
    void correct(const Percept& percept) noexcept;
    void open(const Percept& percept) noexcept;
    void check(const Percept& percept) noexcept;

    const Step& step() const noexcept { return goal_.steps[step_]; }
    const Part& part() const noexcept { return goal_.parts[static_cast<std::size_t>(step().part)]; }
    const Pose& seenPart() const noexcept { return where_[static_cast<std::size_t>(step().part)]; }
    std::int32_t inHand(const Percept& percept) const noexcept { return percept.held[goal_.hand]; }
    bool mayBeDone(const Step& step, std::size_t number, const Percept& percept) const noexcept;
    bool reaches(std::size_t hand, const Vec3& p) const noexcept;
    bool needsHelp(const Step& step) const noexcept;
    bool isOffered(const Step& step, const Percept& percept) const noexcept;
    bool isShared(const Percept& percept) const noexcept;
    Vec3 destination() const noexcept;
    Pose seenGoal() const noexcept;
    Pose seenMouth() const noexcept;
    Vec3 seenGrip() const noexcept { return seenPart() * part().grip; }
    bool isInBore() const noexcept;
    bool looksInserted() noexcept;
    double clearHeight() const noexcept;
    Vec3 errorOfLooking() noexcept;

    const AssembleGoal& goal_;
    Pose X_DEmpty_;                                   // HandRegistration::X_DH of the hand that holds nothing
    Quat q_empty_;                                    // its orientation when it goes for a part
    Pose X_DP_;                                       // the part in the hand
    std::vector<Pose> where_;                         // each part, as last seen
    std::array<Vec3, scene::kMostHands> p_held_{};    // where what each hand holds was when it last moved
    std::array<double, scene::kMostHands> stands_{};  // how long it has stood there [s]
    Stage stage_ = Stage::ToStart;
    std::size_t step_ = 0;
    Quat q_first_;  // the handle's posture when it was taken
    bool turned_ = false;
    int tries_ = 0;  // at the step that were not done when the part was let go
    int looks_ = 0;
    bool gives_ = false;           // the step is another hand's, which does not reach the part
    bool takes_anew_ = false;      // the part is let go to be taken turned
    Vec3 p_taken_ = Vec3::Zero();  // where it was taken
    bool rested_ = false;          // the pause of a lapse is over
};

}  // namespace passung::simulated
