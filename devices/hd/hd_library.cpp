#include "devices/hd/hd_library.h"

#include <fmt/format.h>

#include <limits>

namespace passung::hd {
namespace {

constexpr const char* kUsualFiles[] = {"libHD.so.3.4", "libHD.so"};
constexpr host::LibraryWords kWords{
    "OpenHaptics' library", HdLibrary::kFileVariable, kUsualFiles, "3.4",
    "install OpenHaptics 3.4 for Linux and the driver of the device, both of 3D Systems, "
    "and write the path of its libHD.so"};
constexpr int kMostErrors = 64;  // that a library may keep

}  // namespace

Result<std::unique_ptr<HdLibrary>> HdLibrary::load(const std::string& file) {
    auto opened = host::ClosedLibrary::load(file, kWords);
    if (!opened) return opened.errors();
    std::unique_ptr<HdLibrary> loaded(new HdLibrary(*std::move(opened)));
    loaded->takeFunctions();
    if (const auto complete = loaded->file_->complete(); !complete) return complete.errors();
    return loaded;
}

void HdLibrary::takeFunctions() {
    file_->need(initDevice, "hdInitDevice");
    file_->need(disableDevice, "hdDisableDevice");
    file_->need(makeCurrent, "hdMakeCurrentDevice");
    file_->need(enable, "hdEnable");
    file_->need(beginFrame, "hdBeginFrame");
    file_->need(endFrame, "hdEndFrame");
    file_->need(getDoubles, "hdGetDoublev");
    file_->need(getIntegers, "hdGetIntegerv");
    file_->need(getString, "hdGetString");
    file_->need(setDoubles, "hdSetDoublev");
    file_->need(getError, "hdGetError");
    file_->need(getErrorString, "hdGetErrorString");
    file_->need(checkCalibration, "hdCheckCalibration");
    file_->need(updateCalibration, "hdUpdateCalibration");
    file_->need(setSchedulerRate, "hdSetSchedulerRate");
    file_->need(startScheduler, "hdStartScheduler");
    file_->need(stopScheduler, "hdStopScheduler");
    file_->need(scheduleAsynchronous, "hdScheduleAsynchronous");
}

unsigned HdLibrary::takeError() {
    unsigned oldest = 0;
    for (int i = 0; i < kMostErrors; ++i) {
        const unsigned code = getError().code;
        if (code == 0) break;
        oldest = code;
    }
    return oldest;
}

std::string HdLibrary::words(unsigned error) const {
    const char* said = getErrorString(error);
    return fmt::format("{} (0x{:04x})", said == nullptr ? "no reason given" : said, error);
}

std::string HdLibrary::text(unsigned name) const {
    const char* said = getString(name);
    return said == nullptr ? std::string() : said;
}

double HdLibrary::number(unsigned name) const {
    double value = std::numeric_limits<double>::quiet_NaN();
    getDoubles(name, &value);
    return value;
}

int HdLibrary::integer(unsigned name) const {
    int value = 0;
    getIntegers(name, &value);
    return value;
}

}  // namespace passung::hd
