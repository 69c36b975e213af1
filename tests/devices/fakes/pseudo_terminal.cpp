#include "tests/devices/fakes/pseudo_terminal.h"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "tests/devices/fakes/waiting.h"

namespace passung::fake {

PseudoTerminal::PseudoTerminal(std::filesystem::path link) : link_(std::move(link)) { plug(); }

PseudoTerminal::~PseudoTerminal() { unplug(); }

void PseudoTerminal::plug() {
    unplug();
    master_ = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
    std::array<char, 64> name{};
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0 ||
        ptsname_r(master_, name.data(), name.size()) != 0)
        throw std::runtime_error("no pseudo-terminal");
    slave_ = open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios line{};
    if (slave_ < 0 || tcgetattr(slave_, &line) != 0) throw std::runtime_error("pseudo-terminal cannot be opened");
    cfmakeraw(&line);
    tcsetattr(slave_, TCSANOW, &line);
    std::filesystem::remove(link_);
    std::filesystem::create_symlink(name.data(), link_);
}

void PseudoTerminal::unplug() {
    if (slave_ >= 0) close(slave_);
    if (master_ >= 0) close(master_);
    slave_ = master_ = -1;
}

std::string PseudoTerminal::take(int milliseconds) {
    if (!readable(master_, milliseconds)) return {};
    std::array<char, 4096> bytes{};
    const ssize_t count = read(master_, bytes.data(), bytes.size());
    return {bytes.data(), count > 0 ? static_cast<std::size_t>(count) : 0};
}

bool PseudoTerminal::give(const std::string& bytes) {
    return write(master_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
}

}  // namespace passung::fake
