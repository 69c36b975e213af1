#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace passung::window {

/// What on the screen means an emergency stop. Windows by their ids at the X server, lengths in its pixels.
struct StopTargets {
    std::vector<std::uint32_t> windows;            // Esc stops while one of these, or what is in it, has the keyboard
    std::uint32_t window = 0;                      // that holds the button; 0: the button is not shown
    int left = 0, top = 0, width = 0, height = 0;  // of the button, from that window's corner
    friend bool operator==(const StopTargets&, const StopTargets&) = default;
};

/// Hears an emergency stop at the X server itself, in a thread and over a connection of its own, so that no window has
/// to be alive for it: Esc while one of the program's windows has the keyboard, and a press on the stop button where
/// nothing lies above it. Raw events (XInput 2.2) take nothing away from whoever else hears them.
class StopListener {
public:
    /// `stop` is called from the listener's thread.
    explicit StopListener(std::function<void()> stop);
    ~StopListener();
    StopListener(const StopListener&) = delete;
    StopListener& operator=(const StopListener&) = delete;

    /// False: there is no X server, or one too old.
    bool listens() const { return hearing_ != nullptr; }

    /// From any thread.
    void watch(StopTargets targets);

private:
    struct Hearing;
    std::unique_ptr<Hearing> hearing_;
};

}  // namespace passung::window
