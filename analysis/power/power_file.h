#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/power/effect_test.h"
#include "core/base/result.h"

namespace passung::power {

/// Everything that decides the result. Equal jobs have equal results.
struct PowerJob {
    std::string program;      // version
    std::string study;        // name and version
    std::string plan_sha256;  // of the protocol's text and all numbers that it came to on this machine
    std::uint64_t seed = 0;
    std::string simulation;  // "haptic" or "model"
    int participants = 0;    // of each virtual study
    int repeats = 0;         // virtual studies
    double drop_out = 0.0;   // share of participants who leave before the end
    std::string measure;
    std::string effect;   // as readEffect takes it
    std::string against;  // level
    std::string test;     // as chooseTest gives it
    double alpha = 0.05;

    friend bool operator==(const PowerJob&, const PowerJob&) = default;
};

/// Of the virtual studies 0 … repeats - 1 those whose number leaves index - 1 when divided by `of`.
struct Shard {
    int index = 1;  // 1 … of
    int of = 1;
    bool has(std::int64_t run) const { return run % of == index - 1; }

    friend bool operator==(const Shard&, const Shard&) = default;
};

/// From "2/8"; nothing if that is none.
std::optional<Shard> shardNamed(std::string_view text);

struct StudyTest {
    std::int64_t run = 0;
    EffectTest test;
};

struct PowerResult {
    PowerJob job;
    Shard shard;
    std::vector<StudyTest> tests;  // of every run of the shard, ascending
};

/// As a file: job and shard as comments, then a CSV row per virtual study. Equal results give equal bytes.
std::string powerText(const PowerResult& result);

/// Reads that back; an error names line and key. `file` is for messages.
Result<PowerResult> readPowerText(const std::string& text, const std::string& file);

/// The result of the whole job from all its shards, in any order: the same as if it had been run in one.
/// `files` are their names, for messages. @pre as many as results
Result<PowerResult> merge(const std::vector<PowerResult>& shards, const std::vector<std::string>& files);

}  // namespace passung::power
