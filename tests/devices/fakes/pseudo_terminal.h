#pragma once

#include <filesystem>
#include <string>

namespace passung::fake {

/// A serial line whose other end is the test: a pseudo-terminal under a name that stays when it is plugged in anew.
class PseudoTerminal {
public:
    explicit PseudoTerminal(std::filesystem::path link);
    ~PseudoTerminal();
    PseudoTerminal(const PseudoTerminal&) = delete;
    PseudoTerminal& operator=(const PseudoTerminal&) = delete;

    const std::filesystem::path& path() const noexcept { return link_; }
    /// What has come; waits a slice for it, or `milliseconds`. Empty if nothing has.
    std::string take(int milliseconds);
    /// False if the line does not take all of it.
    bool give(const std::string& bytes);
    /// The cable is pulled: the terminal is gone. `plug` makes a new one under the same name.
    void unplug();
    void plug();

private:
    std::filesystem::path link_;
    int master_ = -1;  // our end
    int slave_ = -1;   // kept open, so that the terminal outlives who has opened it
};

}  // namespace passung::fake
