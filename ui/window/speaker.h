#pragma once

#include <memory>

#include "ui/sound/sound_feed.h"

namespace passung::window {

/// Plays a feed as long as it lives, in a thread of its own.
class Speaker {
public:
    virtual ~Speaker() = default;
};

/// Opens the computer's sound output; tells the feed which, or that there is none. The feed outlives it.
std::unique_ptr<Speaker> openSpeaker(sound::SoundFeed& feed);

}  // namespace passung::window
