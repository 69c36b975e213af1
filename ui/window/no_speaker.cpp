#include "ui/window/speaker.h"

// Built without Qt Multimedia: every trial is silent, and its data says so.

namespace passung::window {

std::unique_ptr<Speaker> openSpeaker(sound::SoundFeed& feed) {
    feed.setOutput(std::nullopt);
    return std::make_unique<Speaker>();
}

}  // namespace passung::window
