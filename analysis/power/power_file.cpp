#include "analysis/power/power_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "analysis/export/table.h"
#include "core/base/assert.h"

namespace passung::power {
namespace {

constexpr std::string_view kTitle = "# passung power, format 3";
constexpr std::string_view kColumns = "run,n,mean_difference,sd_difference,statistic,p";

/// Every key of the header with its field, in order.
template <class Job, class Visit>
void eachKey(Job& job, Visit visit) {
    visit("program", job.program);
    visit("study", job.study);
    visit("plan_sha256", job.plan_sha256);
    visit("seed", job.seed);
    visit("simulation", job.simulation);
    visit("participants", job.participants);
    visit("repeats", job.repeats);
    visit("drop_out", job.drop_out);
    visit("measure", job.measure);
    visit("effect", job.effect);
    visit("against", job.against);
    visit("test", job.test);
    visit("alpha", job.alpha);
}

std::string textOf(const std::string& value) { return value; }
std::string textOf(double value) { return exporter::cell(value); }
template <class Integer>
std::string textOf(Integer value) {
    return std::to_string(value);
}

bool read(std::string_view text, std::string& value) {
    value = text;
    return true;
}
template <class Number>
bool read(std::string_view text, Number& value) {
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    return problem == std::errc() && end == text.data() + text.size();
}
bool readCell(std::string_view text, double& value) {
    value = std::numeric_limits<double>::quiet_NaN();
    return text == exporter::kMissing || read(text, value);
}

/// Goes through a text line by line and keeps the first thing that is wrong.
class Lines {
public:
    Lines(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

    std::string_view next() {
        ++number_;
        const std::size_t length = std::min(rest_.find('\n'), rest_.size());
        const std::string_view line = rest_.substr(0, length);
        rest_.remove_prefix(std::min(length + 1, rest_.size()));
        return line;
    }
    bool atEnd() const { return rest_.empty(); }
    void wrong(const std::string& key, std::string_view value, const std::string& requirement) {
        if (errors_.empty()) errors_.push_back({requirement, file_, number_, 1, key, std::string(value)});
    }
    const Errors& errors() const { return errors_; }

private:
    std::string_view rest_;
    std::string file_;
    int number_ = 0;
    Errors errors_;
};

/// What stands behind "# key = ".
std::string_view valueOf(Lines& lines, const std::string& key) {
    const std::string_view line = lines.next();
    const std::string start = "# " + key + " = ";
    if (line.starts_with(start)) return line.substr(start.size());
    lines.wrong(key, line, "must stand here");
    return {};
}

Shard readShard(Lines& lines) {
    const std::string_view text = valueOf(lines, "shard");
    const auto shard = shardNamed(text);
    if (!shard) lines.wrong("shard", text, "must be i/n with 1 ≤ i ≤ n");
    return shard.value_or(Shard{});
}

void readTest(Lines& lines, std::int64_t run, std::vector<StudyTest>& tests) {
    const std::string_view line = lines.next();
    std::vector<std::string_view> cells;
    for (std::size_t begin = 0; begin <= line.size();) {
        const std::size_t end = std::min(line.find(',', begin), line.size());
        cells.push_back(line.substr(begin, end - begin));
        begin = end + 1;
    }
    StudyTest test;
    const bool good = cells.size() == 6 && read(cells[0], test.run) && test.run == run && read(cells[1], test.test.n) &&
                      readCell(cells[2], test.test.mean) && readCell(cells[3], test.test.sd) &&
                      readCell(cells[4], test.test.statistic) && readCell(cells[5], test.test.p);
    if (!good) lines.wrong("run", line, fmt::format("must be run {}: {}", run, kColumns));
    tests.push_back(test);
}

}  // namespace

std::optional<Shard> shardNamed(std::string_view text) {
    const std::size_t slash = std::min(text.find('/'), text.size());
    Shard shard;
    const bool good = slash < text.size() && read(text.substr(0, slash), shard.index) &&
                      read(text.substr(slash + 1), shard.of) && shard.index >= 1 && shard.index <= shard.of;
    return good ? std::optional(shard) : std::nullopt;
}

std::string powerText(const PowerResult& result) {
    std::string text(kTitle);
    text += '\n';
    eachKey(result.job,
            [&](const char* key, const auto& value) { text += fmt::format("# {} = {}\n", key, textOf(value)); });
    text += fmt::format("# shard = {}/{}\n{}\n", result.shard.index, result.shard.of, kColumns);
    for (const StudyTest& row : result.tests) {
        text +=
            fmt::format("{},{},{},{},{},{}\n", row.run, row.test.n, exporter::cell(row.test.mean),
                        exporter::cell(row.test.sd), exporter::cell(row.test.statistic), exporter::cell(row.test.p));
    }
    return text;
}

Result<PowerResult> readPowerText(const std::string& text, const std::string& file) {
    Lines lines(text, file);
    PowerResult result;
    if (const auto title = lines.next(); title != kTitle)
        lines.wrong({}, title.substr(0, 60), fmt::format("must be \"{}\"", kTitle));
    eachKey(result.job, [&](const char* key, auto& value) {
        const std::string_view word = valueOf(lines, key);
        if (!read(word, value)) lines.wrong(key, word, "must be a number of its kind");
    });
    result.shard = readShard(lines);
    if (const auto columns = lines.next(); columns != kColumns)
        lines.wrong({}, columns.substr(0, 60), fmt::format("must be \"{}\"", kColumns));
    for (std::int64_t run = 0; run < result.job.repeats && lines.errors().empty(); ++run)
        if (result.shard.has(run)) readTest(lines, run, result.tests);
    if (!lines.atEnd()) lines.wrong({}, lines.next().substr(0, 60), "must be the end of the file");
    if (!lines.errors().empty()) return lines.errors();
    return result;
}

Result<PowerResult> merge(const std::vector<PowerResult>& shards, const std::vector<std::string>& files) {
    PASSUNG_ASSERT(shards.size() == files.size() && !shards.empty());
    const PowerResult& first = shards.front();
    std::vector<std::string> from(static_cast<std::size_t>(first.shard.of));
    PowerResult whole{first.job, {}, {}};
    for (std::size_t i = 0; i < shards.size(); ++i) {
        if (!(shards[i].job == first.job) || shards[i].shard.of != first.shard.of)
            return Error{.message = "is a shard of another job than " + files.front(), .file = files[i]};
        std::string& place = from[static_cast<std::size_t>(shards[i].shard.index - 1)];
        if (!place.empty())
            return Error{.message = fmt::format("is shard {} again, after {}", shards[i].shard.index, place),
                         .file = files[i]};
        place = files[i];
        whole.tests.insert(whole.tests.end(), shards[i].tests.begin(), shards[i].tests.end());
    }
    if (const auto missing = std::find(from.begin(), from.end(), ""); missing != from.end())
        return Error{.message = fmt::format("shard {} of {} is missing", missing - from.begin() + 1, from.size()),
                     .key = "--merge"};
    std::sort(whole.tests.begin(), whole.tests.end(),
              [](const StudyTest& a, const StudyTest& b) { return a.run < b.run; });
    return whole;
}

}  // namespace passung::power
