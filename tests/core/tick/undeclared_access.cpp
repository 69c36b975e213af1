#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/stage.h"
#include "core/tick/tick_frame.h"

// An effect as stage.h shows it, and with FAULTS what it may not do: undeclared_access.cmake wants an error at each of
// those lines.

namespace passung::tick {

struct Hum {
    double phase = 0.0;
};

void renderHum(const HandModel& model, const Reading& device, const HandSample& hand, const Proxy& proxy, Hum& hum,
               HandWrench& wrench) noexcept {
    hum.phase += hand.X_WH.p.x() + proxy.X_WG.p.x() + device.reading.X_BD.p.x();
    wrench.F_H_W.force.x() += hum.phase * model.contact.stiffness;
#ifdef FAULTS
    hand.X_WH.p.x() = 0.0;                        // FAULT: writes what it declares to read
    model.contact.stiffness = 0.0;                // FAULT: writes the model
    proxy.manifold.clear();                       // FAULT: changes a list that it declares to read
    proxy.manifold.begin()->phi = 0.0;            // FAULT: writes through an element of it
    static_cast<TickFrame&>(wrench).status = 0;   // FAULT: goes from a part to the whole
    static_cast<HandState&>(hum).engaged = true;  // FAULT: the same in what lasts
    device.reading.fresh = true;                  // FAULT: writes the reading
    for (contact::ContactPoint& point : proxy.manifold) point.phi = 0.0;  // FAULT: writes the elements
#endif
}

void takesState(const HandModel&, HandState&) noexcept;
void takesFrame(const HandModel&, const TickFrame&) noexcept;
void writesReading(const HandModel&, Reading&) noexcept;
void takesCopy(const HandModel&, HandSample) noexcept;
void writesModel(HandModel&, Hum&) noexcept;
void mayThrow(const HandModel&, Hum&);

inline constexpr StageCard kCard{.name = "hum",
                                 .parameters = "",
                                 .cost = "constant",
                                 .needs = [](const HandModel&) { return true; },
                                 .reason = [](const HandModel&) { return "always"; }};
inline constexpr StageOf kHum{renderHum, kCard};

#ifdef FAULTS
inline constexpr StageOf kWholeState{takesState, kCard};        // FAULT: sees the whole state
inline constexpr StageOf kWholeFrame{takesFrame, kCard};        // FAULT: sees the whole frame
inline constexpr StageOf kWritesReading{writesReading, kCard};  // FAULT: declares to write the reading
inline constexpr StageOf kCopy{takesCopy, kCard};               // FAULT: takes a part by value
inline constexpr StageOf kWritesModel{writesModel, kCard};      // FAULT: declares to write the model
inline constexpr StageOf kThrows{mayThrow, kCard};              // FAULT: may throw
#endif

}  // namespace passung::tick
