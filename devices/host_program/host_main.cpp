#include <algorithm>
#include <csignal>
#include <cstdio>
#include <iterator>
#include <string_view>

#include "devices/dhd/dhd_link.h"
#include "devices/hd/hd_link.h"
#include "devices/host/serve_link.h"

// The program passung-device-host: owns the device of a closed library for passung, so that nothing that the library
// does can be done to passung, and so that the force ends when passung does.
namespace {

using namespace passung;

struct Hosted {
    std::string_view backend;
    host::HostedLibrary library;
};

template <class Link>
std::unique_ptr<unit::Link> made(const DeviceChoice& choice, const DeviceDescription& limits) {
    return std::make_unique<Link>(choice, limits);
}

constexpr Hosted kHosted[] = {{"dhd", {dhd::look, made<dhd::DhdLink>}}, {"hd", {hd::look, made<hd::HdLink>}}};

}  // namespace

int main(int argc, char** argv) {
    const auto* hosted = argc == 2 ? std::find_if(std::begin(kHosted), std::end(kHosted),
                                                  [&](const Hosted& one) { return one.backend == argv[1]; })
                                   : std::end(kHosted);
    const int code = hosted == std::end(kHosted) ? 2 : host::serveLibrary(hosted->library);
    if (code == 2)
        std::fputs("passung-device-host drives a haptic device for passung, which starts it: passung doctor\n", stderr);
    return code;
}
