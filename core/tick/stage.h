#pragma once

#include <type_traits>

namespace passung::tick {

struct HandModel;
struct HandState;
struct TickFrame;

/// A whole that is the product of its parts, each a struct of its own: a reference to the whole is one to any of them,
/// and no part leads to another. A part says by kHandedOn that several stages of a scene write it, and by kOnlyRead
/// that none does; every other has one owner in a scene.
template <class... Part>
struct Parts : Part... {};

/// What a stage declares beside what its function takes.
struct StageCard {
    const char* name;
    const char* parameters;                   // keys of the scene that it follows; empty: none
    const char* cost;                         // in a tick
    bool senses = false;                      // finds out where the hand is: comes before any part moves
    bool before_start = false;                // runs also while the start gate is closed
    bool (*needs)(const HandModel&);          // whether a scene has what it is for
    const char* (*reason)(const HandModel&);  // why the scene has it
    // Why a scene that does not have it can do without; null: it serves another stage, which says it.
    const char* (*spared)(const HandModel&) = nullptr;
};

namespace declared {

template <class Part>
inline constexpr bool kOnlyRead = requires {
    Part::kOnlyRead;
};
template <class Part>
inline constexpr bool kHandedOn = requires {
    Part::kHandedOn;
};

/// True for a reference to one part; a part that is only read, by const reference.
template <class Argument>
inline constexpr bool kIsPart = [] {
    using Part = std::remove_cvref_t<Argument>;
    constexpr bool whole =
        std::is_same_v<Part, HandModel> || std::is_same_v<Part, HandState> || std::is_same_v<Part, TickFrame>;
    constexpr bool reads = std::is_const_v<std::remove_reference_t<Argument>>;
    return std::is_lvalue_reference_v<Argument> && !whole && (reads || !kOnlyRead<Part>);
}();

}  // namespace declared

/// One stage of the tick, declared once. Its function takes the model, a const reference to each part that it reads and
/// a reference to each that it owns or hands on; it sees nothing else. The parts are those of HandState, which last,
/// and of TickFrame, which die with the tick. An effect that hums:
///
///   struct Humming { double phase = 0.0; };                                             // its own state
///   struct HumShare { Wrench of_hum; };                                                 // and what it adds
///   void renderHum(const HandModel&, const HandSample&, Humming&, HumShare&) noexcept;  // reads, owns, owns
///   inline constexpr StageOf kHum{renderHum, {.name = "hum", .parameters = "effects.hum", // its card
///                                             .cost = "constant", .needs = ..., .reason = ..., .spared = ...}};
///
/// goes into hum.h and hum.cpp, in the room's CMakeLists.txt. Then
///   - scene::Effects (core/scene/scene_spec.h) gets its parameters, a Hum, which it finds in HandModel::effects,
///   - tick_frame.h HumShare, TickFrame (step.h) the part, effect_sum.h, which adds it, WrenchEffect (tick_record.h)
///     its name, HandModel::wrenchEffects (hand_model.cpp) when, makeRecord (step.cpp) its place in records,
///   - forgetPast (pick.cpp) what of Humming tells of the past, where the hand takes another part,
///   - hand_state.h the header, HandState the part Humming and AllStages, at its place in the order, kHum,
///   - tests/support/every_effect.h the effect: stage_test.cpp says whether the declaration is true.
/// Memory that depends on the scene is sized in makeState (hand_state.cpp).
template <class... Argument>
struct StageOf {
    static_assert((declared::kIsPart<Argument> && ...), "a stage takes parts by reference, never a whole");

    void (*compute)(const HandModel&, Argument...) noexcept;
    StageCard card;

    /// Runs it on its parts of `state` and `frame`. rt-safe.
    void operator()(const HandModel& model, HandState& state, TickFrame& frame) const noexcept {
        compute(model, partOf<Argument>(state, frame)...);
    }

private:
    template <class Wanted>
    static Wanted partOf(HandState& state, TickFrame& frame) noexcept {
        if constexpr (std::is_base_of_v<std::remove_cvref_t<Wanted>, HandState>)
            return state;
        else
            return frame;
    }
};
template <class... Argument>
StageOf(void (*)(const HandModel&, Argument...) noexcept, StageCard) -> StageOf<Argument...>;

/// A stage of one scene. `reason` says why this scene has it.
struct Stage {
    const char* name;
    const char* reason;
    bool senses;        // comes before any part moves
    bool before_start;  // runs also while the start gate is closed
    void (*run)(const HandModel&, HandState&, TickFrame&) noexcept;
};

/// A stage that a scene does not have, and why.
struct SparedStage {
    const char* name;
    const char* reason;
};

/// Stages in the order of the tick.
template <const auto&... stage>
struct StageList {};

}  // namespace passung::tick
