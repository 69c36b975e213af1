#include "study/protocol/include.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <sstream>

#include "core/base/regular_file.h"
#include "study/protocol/condition_table.h"
#include "study/protocol/text_limits.h"

namespace passung::protocol {
namespace {

/// The file that a line includes, with the column of its name.
struct Directive {
    std::string file;
    int column = 1;
};

/// Of a line that says `word = "FILE"`; nothing for any other.
std::optional<Directive> directiveOf(const std::string& line, std::string_view word) {
    if (!line.starts_with(word)) return std::nullopt;
    std::size_t at = line.find_first_not_of(" \t", word.size());
    if (at == std::string::npos || line[at] != '=') return std::nullopt;
    at = line.find_first_not_of(" \t", at + 1);
    if (at == std::string::npos || line[at] != '"') return std::nullopt;
    const std::size_t end = line.find('"', at + 1);
    if (end == std::string::npos) return std::nullopt;
    const std::size_t rest = line.find_first_not_of(" \t\r", end + 1);
    if (rest != std::string::npos && line[rest] != '#') return std::nullopt;
    return Directive{line.substr(at + 1, end - at - 1), static_cast<int>(at) + 1};
}

constexpr int kMostIncludes = 256;

/// Goes through one file and the files that it includes.
class Includer {
public:
    explicit Includer(IncludedText& result) : result_(result) {}

    void add(const std::string& text, const std::string& path) {
        open_.push_back(path);
        std::istringstream lines(text);
        std::string line;
        for (int number = 1; !full_ && std::getline(lines, line); ++number) {
            if (const auto directive = directiveOf(line, "include"))
                include(*directive, {path, number, directive->column});
            else if (const auto table = directiveOf(line, "conditions"))
                list(*table, {path, number, table->column});
            else
                put(line, {path, number, 1});
        }
        open_.pop_back();
    }

    bool found() const { return found_; }
    const Errors& errors() const { return errors_; }

private:
    void put(const std::string& line, const TextPosition& place) {
        if (full_) return;
        full_ = result_.text.size() + line.size() > kMostProtocolBytes;
        if (full_)
            return errors_.push_back(errorAt(place, "", "",
                                             fmt::format("with all that it includes the text must be of "
                                                         "at most {} MiB",
                                                         kMostProtocolBytes >> 20)));
        result_.text += line + '\n';
        result_.lines.push_back(place);
    }

    /// The rows of a table in the place of its line.
    void list(const Directive& directive, const TextPosition& place) {
        found_ = true;
        const auto path = (std::filesystem::path(place.file).parent_path() / directive.file).string();
        const auto text = readFile(path);
        if (!text) {
            errors_.push_back(
                errorAt(place, "conditions", fmt::format("\"{}\"", directive.file), text.errors().front().message));
            return;
        }
        const auto lines = conditionLines(*text, path, directive.file);
        if (!lines) {
            errors_.insert(errors_.end(), lines.errors().begin(), lines.errors().end());
            return;
        }
        for (const ListedLine& line : *lines) put(line.text, {path, line.line, 1});
    }

    void include(const Directive& directive, const TextPosition& place) {
        found_ = true;
        const auto report = [&](std::string message) {
            errors_.push_back(errorAt(place, "include", fmt::format("\"{}\"", directive.file), std::move(message)));
        };
        if (directive.file.find('/') != std::string::npos)
            return report("must be a file in the study's folder, so that paths in it mean the same");
        const auto path = (std::filesystem::path(place.file).parent_path() / directive.file).string();
        if (++count_ > kMostIncludes) {
            full_ = true;
            return report(fmt::format("is one more than the {} files that may be included", kMostIncludes));
        }
        if (std::find(open_.begin(), open_.end(), path) != open_.end()) return report("includes itself");
        const auto text = readFile(path);
        if (!text) return report(text.errors().front().message);
        put(fmt::format("# {} begins", directive.file), place);
        add(*text, path);
        put(fmt::format("# {} ends", directive.file), place);
    }

    IncludedText& result_;
    std::vector<std::string> open_;
    bool found_ = false;
    bool full_ = false;  // nothing more is taken
    int count_ = 0;      // of included files
    Errors errors_;
};

}  // namespace

Result<IncludedText> includeFiles(const std::string& text, const std::string& path) {
    IncludedText result;
    Includer includer(result);
    includer.add(text, path);
    if (!includer.errors().empty()) return includer.errors();
    if (!includer.found()) return IncludedText{text, {}};
    return result;
}

void relocate(const IncludedText& included, TextPosition& place) {
    if (included.lines.empty()) return;
    const auto line = std::min(static_cast<std::size_t>(std::max(place.line, 1)), included.lines.size());
    place.file = included.lines[line - 1].file;
    place.line = included.lines[line - 1].line;
}

void relocate(const IncludedText& included, Node& document) {
    if (included.lines.empty()) return;
    relocate(included, document.place);
    for (Node& item : document.items) relocate(included, item);
    for (Entry& entry : document.entries) {
        relocate(included, entry.place);
        relocate(included, entry.value);
    }
}

}  // namespace passung::protocol
