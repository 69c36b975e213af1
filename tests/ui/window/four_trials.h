#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace passung::test {

inline std::string textOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// Tables of a protocol by which each attempt counts, however slow the machine is: else a session of repeated attempts
/// ends before its last trial.
inline constexpr const char* kOnAnyMachine =
    "\n[loop]\nmax_missed_share = 1\n[view]\nmax_picture_age_ms = 600000\nmin_pictures_per_s = 0\n";

/// protocols/peg_in_hole with four of its conditions, without practice, with time enough for a hand that is slow and a
/// machine that misses cycles and pictures; a trial that does not count is repeated. Its questionnaires as they are; no
/// consent.
inline std::string fourTrials() {
    std::string text = textOf(PASSUNG_SOURCE_DIR "/protocols/peg_in_hole/study.toml");
    const auto swap = [&text](const std::string& from, const std::string& to) {
        const std::size_t at = text.find(from);
        if (at == std::string::npos) throw std::runtime_error("protocols/peg_in_hole no longer has " + from);
        text.replace(at, from.size(), to);
    };
    swap("participants = 12", "participants = 4");
    swap("  { label = \"0.1\", value = 20.2 },\n", "  { label = \"0.4\", value = 20.8 },\n");
    swap(R"(levels = ["penalty", "god_object_heuristic", "god_object"])", R"(levels = ["penalty", "god_object"])");
    swap("[[factor]]\nname = \"stiffness\"\nkey = \"contact.stiffness_N_per_m\"\nlevels = [\"0.5 max\", \"max\"]", "");
    swap(R"(factors = ["clearance", "method", "stiffness"])", R"(factors = ["clearance", "method"])");
    swap("cell_mm = 0.5 ", "stiffness_N_per_m = \"0.5 max\"\ncell_mm = 0.5 ");
    swap("timeout_s = 30", "timeout_s = 3000");
    const auto drop = [&text](const std::string& from, const std::string& to) {
        const std::size_t at = text.find(from), end = text.find(to, at);
        if (end == std::string::npos) throw std::runtime_error("protocols/peg_in_hole no longer has " + from);
        text.erase(at, end - at);
    };
    drop("[[factor]]\nname = \"geometry\"", "# ---- What a trial asks for");
    drop("[[block]]\nname = \"practice\"", "[[block]]\nname = \"main\"");
    drop("# Twelve, each with the geometry", "\n[[block]]\nname = \"geometry\"");
    drop("[[block]]\nname = \"geometry\"", "# ---- What is asked");
    drop("[[analysis]]\noutcome = \"time_s\"\nblock = \"geometry\"", "# ---- What people agree to");
    swap("repetitions = 2", "repetitions = 1\non_invalid = \"repeat_at_block_end\"");
    swap("moment = \"after_condition\"       # after the last trial of each condition\nblock = \"main\"",
         "moment = \"session_end\"");
    const std::size_t consent = text.find("# ---- What people agree to");
    if (consent == std::string::npos) throw std::runtime_error("protocols/peg_in_hole no longer asks for consent");
    text.erase(consent, text.find("# Without `measures") - consent);
    return text + kOnAnyMachine;
}

/// A folder of studies with this one, and the questionnaires beside it. Returns the study's file.
inline std::string writeFourTrials(const std::string& folder) {
    std::filesystem::create_directories(folder + "/four_trials");
    std::filesystem::copy(PASSUNG_SOURCE_DIR "/protocols/questionnaires", folder + "/questionnaires");
    std::string file = folder + "/four_trials/study.toml";
    std::ofstream(file, std::ios::binary) << fourTrials();
    return file;
}

}  // namespace passung::test
