#include <minizip/unzip.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <sstream>

#include "core/import/scene_file_limits.h"

namespace passung::importer {

namespace {

/// Goes through the tags of an XML text.
class TagScan {
public:
    explicit TagScan(std::string_view text) : text_(text) {}

    /// Goes to the next tag of an element; false at the end.
    bool next() {
        for (;;) {
            at_ = text_.find('<', at_);
            if (at_ == std::string_view::npos) return false;
            const std::string_view rest = text_.substr(at_);
            if (rest.starts_with("<!--")) {
                skip("-->");
            } else if (rest.starts_with("<![CDATA[")) {
                skip("]]>");
            } else if (rest.starts_with("<?") || rest.starts_with("<!")) {
                skip(">");
            } else {
                takeTag();
                return true;
            }
        }
    }

    bool ends() const { return tag_.starts_with("/"); }
    bool empty() const { return tag_.ends_with("/"); }
    /// Without the prefix of a namespace.
    std::string_view name() const {
        const std::string_view name = tag_.substr(0, tag_.find_first_of(" \t\r\n/"));
        return name.substr(name.rfind(':') + 1);
    }
    /// The value of an attribute; nothing if there is none.
    std::string_view attribute(std::string_view wanted) const {
        for (std::size_t at = tag_.find(wanted); at != std::string_view::npos; at = tag_.find(wanted, at + 1)) {
            if (at == 0 || std::string_view(" \t\r\n").find(tag_[at - 1]) == std::string_view::npos) continue;
            const std::size_t equals = tag_.find_first_not_of(" \t\r\n", at + wanted.size());
            if (equals == std::string_view::npos || tag_[equals] != '=') continue;
            const std::size_t open = tag_.find_first_of("\"'", equals);
            if (open == std::string_view::npos) return {};
            return tag_.substr(open + 1, tag_.find(tag_[open], open + 1) - open - 1);
        }
        return {};
    }

private:
    void skip(std::string_view end) {
        const std::size_t found = text_.find(end, at_ + 2);
        at_ = found == std::string_view::npos ? text_.size() : found + end.size();
    }

    void takeTag() {
        const std::size_t begin = ++at_;
        char quote = 0;
        for (; at_ < text_.size() && (quote != 0 || text_[at_] != '>'); ++at_) {
            const char c = text_[at_];
            if (quote != 0)
                quote = c == quote ? '\0' : quote;
            else if (c == '"' || c == '\'')
                quote = c;
        }
        tag_ = text_.substr(begin, at_ - begin);
    }

    std::string_view text_, tag_;
    std::size_t at_ = 0;
};

/// The number that names an object, however it is written.
std::string idOf(std::string_view text) {
    const std::string written(text);
    const bool hex = written.find("0x") != std::string::npos || written.find("0X") != std::string::npos;
    return std::to_string(std::strtoll(written.c_str(), nullptr, hex ? 16 : 10));
}

/// A reader of XML would see another id in it.
bool isReferred(std::string_view id) { return id.find('&') != std::string_view::npos; }
constexpr const char* kReferred = "an object's id is written with a character reference";

/// Numbers parted by white space; another reader would stop at a word by an exception and lose what it holds.
bool isOfNumbers(std::string_view text) {
    std::istringstream words{std::string(text)};
    for (std::string word; words >> word;) {
        char* end = nullptr;
        const float number = std::strtof(word.c_str(), &end);
        if (*end != '\0' || !std::isfinite(number)) return false;
    }
    return true;
}

/// Judges the elements of a model: how deep they are, and which object stands in which.
std::optional<std::string> judgeModel(std::string_view xml) {
    Nesting nesting;
    const std::size_t all = nesting.number("all");
    std::size_t object = all;
    int depth = 0;
    TagScan tags(xml);
    while (tags.next()) {
        if (tags.ends()) {
            --depth;
            continue;
        }
        if (!tags.empty() && ++depth > SceneFileLimits::kMostDepth)
            return "its XML must be at most " + std::to_string(SceneFileLimits::kMostDepth) + " levels deep";
        const std::string_view name = tags.name();
        if (name == "object") {
            const std::string_view id = tags.attribute("id");
            if (isReferred(id)) return kReferred;
            object = nesting.number(idOf(id));
        } else if (name == "component" || name == "item") {
            const std::string_view id = tags.attribute("objectid");
            if (isReferred(id)) return kReferred;
            if (!isOfNumbers(tags.attribute("transform"))) return "a transform in it must be of finite numbers alone";
            const std::size_t inner = nesting.number(idOf(id));
            nesting[name == "item" ? all : object].inner.push_back(inner);
        } else if (name == "triangle") {
            nesting[object].corners += 3.0;
        }
    }
    return nesting.tooMuch(all);
}

/// Whatever its name is: models and what names them.
bool isXml(std::string_view content) {
    if (content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);
    const std::size_t begin = content.find_first_not_of(" \t\r\n");
    return begin != std::string_view::npos && content[begin] == '<';
}

using Package = std::unique_ptr<void, int (*)(unzFile)>;

/// The whole entry that the package is at; nothing if it cannot be unpacked.
std::optional<std::string> contentOf(unzFile package, std::size_t size) {
    if (unzOpenCurrentFile(package) != UNZ_OK) return std::nullopt;
    std::string content(size, '\0');
    std::size_t done = 0;
    constexpr std::size_t kPiece = std::size_t{1} << 20;
    while (done < size) {
        const int read =
            unzReadCurrentFile(package, content.data() + done, static_cast<unsigned>(std::min(kPiece, size - done)));
        if (read <= 0) break;
        done += static_cast<std::size_t>(read);
    }
    unzCloseCurrentFile(package);
    content.resize(done);
    return content;
}

}  // namespace

std::optional<Error> beyond3mfLimits(const std::string& path, std::uintmax_t size) {
    const auto refused = [&](const std::string& why) {
        return Error{.message = "must be a mesh that can be read: " + why, .file = path};
    };
    const Package package(unzOpen(path.c_str()), &unzClose);
    if (!package) return std::nullopt;  // said by who reads it
    std::uintmax_t left = SceneFileLimits::unpacked(size);
    for (int at = unzGoToFirstFile(package.get()); at == UNZ_OK; at = unzGoToNextFile(package.get())) {
        unz_file_info info{};
        if (unzGetCurrentFileInfo(package.get(), &info, nullptr, 0, nullptr, 0, nullptr, 0) != UNZ_OK) break;
        if (info.uncompressed_size > left)
            return refused("it must hold at most " + std::to_string(SceneFileLimits::unpacked(size) >> 20) +
                           " MiB unpacked");
        left -= info.uncompressed_size;
        const auto content = contentOf(package.get(), info.uncompressed_size);
        if (!content || !isXml(*content)) continue;
        if (const auto why = judgeModel(*content)) return refused(*why);
    }
    return std::nullopt;
}

}  // namespace passung::importer
