#pragma once

#include <functional>

#include "devices/unit/link.h"

namespace passung::host {

/// A link whose library has a servo thread of its own, in which alone it may be exchanged with.
class PacedLink : public unit::Link {
public:
    /// Lets the library's thread call `cycle` at each of its ticks until it returns false; waits for that. @pre open()
    virtual Result<Done> pace(const std::function<bool()>& cycle) = 0;
};

}  // namespace passung::host
