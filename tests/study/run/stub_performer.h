#pragma once

#include "study/run/person/performer.h"

namespace passung::test {

/// Somebody with a device at a computer that shows nothing.
class StubPerformer : public run::Performer {
public:
    plan::ParticipantKind kind() const override { return plan::ParticipantKind::Pilot; }
    std::unique_ptr<loop::HapticDevice> device(const simulated::DeviceParams&, const plan::Condition&) override {
        return nullptr;
    }
    DeviceDescription describe(const simulated::DeviceParams&) const override { return {}; }
    std::span<loop::ScreenRing* const> screens() override { return {}; }
    session::Presentation presented(std::int64_t, std::int64_t, std::int64_t) override { return {}; }
    session::QuestionnaireSource* answers() override { return nullptr; }
    session::InstructionReader* reader() override { return nullptr; }
    void begins(session::Apparatus&, const session::SessionSetup&) override {}
    void prepares(const plan::Condition&, std::int64_t, std::uint64_t) override {}
    bool builds(double) override { return true; }
    void betweenSteps(session::Session&) override {}
    void over() override {}
};

}  // namespace passung::test
