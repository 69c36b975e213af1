#include "study/protocol/text_limits.h"

#include <fmt/format.h>

#include <vector>

namespace passung::protocol {
namespace {

/// Goes through a text and counts how deep it is.
class DepthScan {
public:
    explicit DepthScan(std::string_view text) : text_(text) {}

    /// Goes to the place that is too deep; false if there is none.
    bool findTooDeep() {
        while (at_ < text_.size()) {
            take(text_[at_]);
            if (level_ + key_dots_ + dots_ > kMostLevels) return true;
            ++at_;
        }
        return false;
    }

    int line() const { return line_; }
    int column() const { return static_cast<int>(at_ - line_begin_) + 1; }

private:
    void take(char c) {
        switch (c) {
            case '#':
                while (at_ + 1 < text_.size() && text_[at_ + 1] != '\n') ++at_;
                break;
            case '"':
            case '\'':
                skipString(c);
                break;
            case '[':
            case '{':
                open();
                break;
            case ']':
            case '}':
                close();
                break;
            case '.':
                ++dots_;
                break;
            case '=':
                key_dots_ = dots_;
                dots_ = 0;
                break;
            case '\n':
                endLine();
                [[fallthrough]];
            case ',':
                key_dots_ = dots_ = 0;
                break;
            default:
                break;
        }
    }

    void endLine() {
        ++line_;
        line_begin_ = at_ + 1;
    }

    void open() {
        open_.push_back(1 + key_dots_);
        level_ += open_.back();
        key_dots_ = dots_ = 0;
    }

    void close() {
        if (!open_.empty()) {
            level_ -= open_.back();
            open_.pop_back();
        }
        key_dots_ = dots_ = 0;
    }

    /// To the closing quote; of a string of one line no farther than its line.
    void skipString(char quote) {
        const std::string three(3, quote);
        const bool lines = text_.substr(at_, 3) == three;
        at_ += lines ? 3 : 1;
        for (; at_ < text_.size(); ++at_) {
            const char c = text_[at_];
            if (c == '\n') endLine();
            if (c == '\\' && quote == '"') {
                if (at_ + 1 < text_.size() && text_[at_ + 1] != '\n') ++at_;
            } else if (lines && text_.substr(at_, 3) == three) {
                at_ += 2;
                return;
            } else if (!lines && (c == quote || c == '\n')) {
                return;
            }
        }
    }

    std::string_view text_;
    std::size_t at_ = 0, line_begin_ = 0;
    int line_ = 1;
    std::vector<int> open_;  // levels of each open bracket
    int level_ = 0, key_dots_ = 0, dots_ = 0;
};

}  // namespace

std::optional<Error> beyondLimits(std::string_view text, const std::string& file) {
    if (text.size() > kMostProtocolBytes)
        return Error{.message = fmt::format("must be a text of at most {} MiB", kMostProtocolBytes >> 20),
                     .file = file};
    DepthScan scan(text);
    if (!scan.findTooDeep()) return std::nullopt;
    return Error{.message = fmt::format("must be at most {} levels deep, of brackets and of dots in keys", kMostLevels),
                 .file = file,
                 .line = scan.line(),
                 .column = scan.column()};
}

}  // namespace passung::protocol
