#include "study/run/machine/front_file.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "analysis/truth/accuracy_tick_reader.h"
#include "analysis/truth/accuracy_tick_tables.h"
#include "core/base/random.h"
#include "core/base/regular_file.h"

namespace passung::run {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFormat = "1";
constexpr const char *kSimulatedHand = "simulated_hand", *kPressed = "pressed";

const StoredFront* storedOf(const FrontFile& file, const std::string& condition) {
    const auto found = std::find_if(file.fronts.begin(), file.fronts.end(),
                                    [&](const StoredFront& stored) { return stored.condition == condition; });
    return found == file.fronts.end() ? nullptr : &*found;
}

/// Reads line by line.
class Reader {
public:
    Reader(const std::string& text, const std::string& path) : lines_(text), path_(path) {}

    Result<FrontFile> read() {
        for (std::string line; std::getline(lines_, line);) {
            ++line_;
            if (!line.starts_with("#")) {
                if (auto done = readTable(line); !done) return done.errors();
                continue;
            }
            const std::size_t colon = line.find(": ");
            if (colon == std::string::npos) continue;
            if (auto done = readKey(line.substr(2, colon - 2), line.substr(colon + 2)); !done) return done.errors();
        }
        if (!known_format_) return error("is no file of measured fronts: \"# format: 1\" is missing", "");
        for (const StoredFront& stored : file_.fronts)
            if (stored.front.measured.rows.empty()) return error("has no table of this condition", stored.condition);
        return std::move(file_);
    }

private:
    Error error(const std::string& message, const std::string& value) const {
        return {.message = message, .file = path_, .line = line_, .value = value};
    }

    Result<Done> readKey(const std::string& key, const std::string& value) {
        if (key == "format") {
            known_format_ = value == kFormat;
            if (!known_format_) return error("is a format that this program does not know", value);
        } else if (key == "program") {
            file_.program = value;
        } else if (key == "commit") {
            file_.commit = value;
        } else if (key == "machine") {
            file_.machine = value;
        } else if (key == "date") {
            file_.date = value;
        } else if (key == "condition") {
            file_.fronts.push_back({.condition = value, .mark = {}, .front = {}});
        } else if (!file_.fronts.empty()) {
            return readOfCondition(key, value);
        }
        return Done{};
    }

    Result<Done> readOfCondition(const std::string& key, const std::string& value) {
        StoredFront& stored = file_.fronts.back();
        if (key == "mark") {
            stored.mark = value;
        } else if (key == "path") {
            if (value != kSimulatedHand && value != kPressed) return error("is no path of a hand", value);
            stored.front.path = value == kPressed ? HandPath::Origin::Pressed : HandPath::Origin::SimulatedHand;
        } else if (key == "ticks") {
            const auto [end, failed] = std::from_chars(value.data(), value.data() + value.size(), stored.front.ticks);
            if (failed != std::errc() || end != value.data() + value.size()) return error("is no number", value);
        } else if (key == "left out") {
            stored.front.left_out.push_back(value);
        } else if (key == "note") {
            stored.front.measured.notes.push_back(value);
        }
        return Done{};
    }

    /// From its header to the next comment.
    Result<Done> readTable(const std::string& header) {
        if (file_.fronts.empty()) return error("stands before a condition", header);
        const int first = line_;
        std::string text = header + '\n';
        for (std::string line; lines_.peek() != '#' && std::getline(lines_, line); ++line_) text += line + '\n';
        auto rows = truth::readTickCsv(text, path_, first);
        if (!rows) return rows.errors();
        file_.fronts.back().front.measured.rows = *std::move(rows);
        return Done{};
    }

    std::istringstream lines_;
    std::string path_;
    int line_ = 0;
    bool known_format_ = false;
    FrontFile file_;
};

std::string processorName() {
    std::ifstream lines("/proc/cpuinfo");
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("model name"))
            if (const std::size_t colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
    return {};
}

}  // namespace

std::string frontPath(const std::string& study) { return fs::path(study).replace_extension(".front.csv").string(); }

std::string measuringMachine() {
    utsname name{};
    uname(&name);
    const std::string processor = processorName();
    return fmt::format("{} {}, {} processors{}", name.sysname, name.machine, std::thread::hardware_concurrency(),
                       processor.empty() ? "" : ", " + processor);
}

FrontFile newFrontFile(const std::string& commit) {
    const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    return {.program = PASSUNG_VERSION,
            .commit = commit,
            .machine = measuringMachine(),
            .date = fmt::format("{:%Y-%m-%d}", fmt::gmtime(now)),
            .fronts = {}};
}

std::string conditionMark(const plan::Condition& condition) {
    return fmt::format("{:016x}", fnv1a64(condition.params_json));
}

std::string frontFileText(const FrontFile& file) {
    std::string text = fmt::format(
        "# What accuracy costs a tick of this study: `passung accuracy STUDY.toml --measure` wrote it, and measures "
        "anew.\n"
        "# format: {}\n# program: {}\n# commit: {}\n# machine: {}\n# date: {}\n",
        kFormat, file.program, file.commit, file.machine, file.date);
    for (const StoredFront& stored : file.fronts) {
        text +=
            fmt::format("#\n# condition: {}\n# mark: {}\n# path: {}\n# ticks: {}\n", stored.condition, stored.mark,
                        stored.front.path == HandPath::Origin::Pressed ? kPressed : kSimulatedHand, stored.front.ticks);
        for (const std::string& why : stored.front.left_out) text += "# left out: " + why + '\n';
        for (const std::string& note : stored.front.measured.notes) text += "# note: " + note + '\n';
        text += truth::tickCsv(stored.front.measured);
    }
    return text;
}

Result<FrontFile> readFrontText(const std::string& text, const std::string& path) { return Reader(text, path).read(); }

Result<std::optional<FrontFile>> readFronts(const std::string& study) {
    const std::string path = frontPath(study);
    if (!fs::exists(path)) return std::optional<FrontFile>();
    const auto text = readFile(path);
    if (!text) return text.errors();
    auto file = readFrontText(*text, path);
    if (!file) return file.errors();
    return std::optional(*std::move(file));
}

std::optional<TickFront> frontOf(const FrontFile& file, const plan::Condition& condition) {
    const StoredFront* stored = storedOf(file, condition.name);
    if (stored == nullptr) return {};
    TickFront front = stored->front;
    front.own = condition.scene.contact;
    return front;
}

FrontOrigin originOf(const FrontFile& file, const plan::Condition& condition) {
    const StoredFront* stored = storedOf(file, condition.name);
    return {.program = file.program,
            .commit = file.commit,
            .machine = file.machine,
            .date = file.date,
            .elsewhere = file.machine != measuringMachine(),
            .outdated = stored != nullptr && stored->mark != conditionMark(condition)};
}

}  // namespace passung::run
