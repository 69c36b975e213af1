#include <algorithm>
#include <array>

#include "core/base/regular_file.h"
#include "core/import/json_scan.h"
#include "core/import/scene_file_limits.h"

namespace passung::importer {

namespace {

using Index = JsonScan::Index;

std::uint32_t word32(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

/// The JSON of a binary file and how many bytes of buffer it holds itself.
struct BinaryParts {
    std::string_view json;
    double buffer = 0.0;
};

/// Head of 12 bytes, then chunks of length, kind and content; version 1: one length, JSON, then the buffer.
std::optional<BinaryParts> binaryParts(std::string_view bytes) {
    constexpr std::size_t kHead = 20;
    if (bytes.size() < kHead || !bytes.starts_with("glTF")) return std::nullopt;
    const std::size_t length = word32(bytes, 12);
    if (word32(bytes, 8) > bytes.size() || length > bytes.size() - kHead) return std::nullopt;
    BinaryParts parts{bytes.substr(kHead, length), static_cast<double>(bytes.size() - kHead - length)};
    if (word32(bytes, 4) == 1) return parts;
    for (std::size_t at = kHead + length; at + 8 <= bytes.size();) {
        const std::size_t chunk = word32(bytes, at);
        if (chunk > bytes.size() - at - 8) return std::nullopt;
        at += 8 + chunk;
    }
    return parts;
}

/// Judges what a glTF document says of itself. Its tables are lists (version 2) or objects (version 1).
class GltfJudge {
public:
    GltfJudge(const JsonScan& json, double own_buffer, double file_bytes,
              const std::function<std::optional<std::uintmax_t>(const std::string&)>& sizeOf)
        : json_(json), own_buffer_(own_buffer), bytes_(file_bytes), sizeOf_(sizeOf) {}

    std::optional<std::string> judge() {
        for (const auto step :
             {&GltfJudge::judgeBuffers, &GltfJudge::judgeAccessors, &GltfJudge::judgeMeshes, &GltfJudge::judgeNodes})
            if (auto why = (this->*step)()) return why;
        return std::nullopt;
    }

private:
    Index table(const char* name) const { return json_.find(JsonScan::root(), name); }
    Index firstOf(Index list) const {
        const bool holds = list != JsonScan::kNone &&
                           (json_.kind(list) == JsonScan::Kind::List || json_.kind(list) == JsonScan::Kind::Object);
        return holds ? json_.first(list) : JsonScan::kNone;
    }

    /// Every entry of a table with the name by which others mean it.
    template <class Visit>
    void each(const char* name, const Visit& visit) const {
        const Index list = table(name);
        std::size_t number = 0;
        const bool named = list != JsonScan::kNone && json_.kind(list) == JsonScan::Kind::Object;
        for (Index entry = firstOf(list); entry != JsonScan::kNone; entry = json_.next(entry), ++number)
            visit(entry, named ? json_.key(entry) : std::to_string(number));
    }

    /// What a value that means another entry calls it.
    std::string meant(Index value) const {
        const auto number = json_.number(value);
        if (json_.kind(value) == JsonScan::Kind::String || !number || !(*number >= 0.0 && *number < 1e9))
            return json_.text(value);
        return std::to_string(static_cast<std::uint64_t>(*number));
    }

    std::optional<std::string> judgeBuffers() {
        std::optional<std::string> why;
        each("buffers", [&](Index buffer, const std::string& name) {
            const auto stated = json_.number(json_.find(buffer, "byteLength"));
            const Index uri = json_.find(buffer, "uri");
            double there = own_buffer_;
            if (uri != JsonScan::kNone && json_.kind(uri) == JsonScan::Kind::String) {
                const std::string head = json_.text(uri).substr(0, 5);
                const auto size =
                    head == "data:" ? std::optional<std::uintmax_t>(json_.length(uri)) : sizeOf_(json_.text(uri));
                if (!size) why = "buffer " + name + ": the file that it names must be a regular file that may be read";
                there = static_cast<double>(size.value_or(0));
                if (head != "data:") bytes_ += there;
            }
            if (!why && stated && !(*stated >= 0.0 && *stated <= there))
                why = "buffer " + name + ": says that it holds more bytes than are there";
        });
        if (!why && bytes_ > static_cast<double>(kMostMeshBytes))
            why = "the files that it names must be smaller than 4 GiB together";
        return why;
    }

    std::optional<std::string> judgeAccessors() {
        std::optional<std::string> why;
        each("accessors", [&](Index accessor, const std::string& name) {
            const double count = json_.number(json_.find(accessor, "count")).value_or(0.0);
            if (!(count >= 0.0 && count <= bytes_))
                why = "accessor " + name + ": says that it holds more than is there";
            counts_[name] = count;
        });
        return why;
    }

    double countOf(Index accessor) const {
        if (accessor == JsonScan::kNone) return 0.0;
        const auto found = counts_.find(meant(accessor));
        return found != counts_.end() ? found->second : 0.0;
    }

    std::optional<std::string> judgeMeshes() {
        double all = 0.0;
        each("meshes", [&](Index mesh, const std::string& name) {
            double corners = 0.0;
            for (Index p = firstOf(json_.find(mesh, "primitives")); p != JsonScan::kNone; p = json_.next(p)) {
                corners += countOf(json_.find(p, "indices"));
                const Index attributes = json_.find(p, "attributes");
                for (Index a = firstOf(attributes); a != JsonScan::kNone; a = json_.next(a)) corners += countOf(a);
                for (Index t = firstOf(json_.find(p, "targets")); t != JsonScan::kNone; t = json_.next(t))
                    for (Index a = firstOf(t); a != JsonScan::kNone; a = json_.next(a)) corners += countOf(a);
            }
            nesting_[nesting_.number("mesh " + name)].corners = corners;
            all += corners;
        });
        if (all > SceneFileLimits::kMostCorners) return "its meshes must name at most 150000000 numbers together";
        return std::nullopt;
    }

    /// Version 2 names a node's mesh, version 1 its meshes; children are numbers or names. Only scenes are read.
    std::optional<std::string> judgeNodes() {
        const auto add = [&](std::size_t outer, const char* kind, Index value) {
            const std::size_t inner = nesting_.number(kind + meant(value));
            nesting_[outer].inner.push_back(inner);
        };
        each("nodes", [&](Index node, const std::string& name) {
            const std::size_t outer = nesting_.number("node " + name);
            for (Index c = firstOf(json_.find(node, "children")); c != JsonScan::kNone; c = json_.next(c))
                add(outer, "node ", c);
            for (Index m = firstOf(json_.find(node, "meshes")); m != JsonScan::kNone; m = json_.next(m))
                add(outer, "mesh ", m);
            if (const Index mesh = json_.find(node, "mesh"); mesh != JsonScan::kNone) add(outer, "mesh ", mesh);
        });
        const std::size_t all = nesting_.number("all");
        each("scenes", [&](Index scene, const std::string&) {
            for (Index n = firstOf(json_.find(scene, "nodes")); n != JsonScan::kNone; n = json_.next(n))
                add(all, "node ", n);
        });
        return nesting_.tooMuch(all);
    }

    const JsonScan& json_;
    double own_buffer_, bytes_;
    const std::function<std::optional<std::uintmax_t>(const std::string&)>& sizeOf_;
    std::map<std::string, double> counts_;
    Nesting nesting_;
};

}  // namespace

std::optional<Error> beyondGltfLimits(std::string_view bytes, bool binary, const std::string& file,
                                      const std::function<std::optional<std::uintmax_t>(const std::string&)>& sizeOf) {
    const auto refused = [&](const std::string& why) {
        return Error{.message = "must be a mesh that can be read: " + why, .file = file};
    };
    BinaryParts parts{bytes, 0.0};
    if (binary) {
        const auto found = binaryParts(bytes);
        if (!found) return refused("its head says that it holds more bytes than are there, or is no head of glTF");
        parts = *found;
    }
    std::string why;
    // Chunks of JSON may be filled up with zeros.
    const std::size_t end = parts.json.find_last_not_of(std::string_view("\0", 1));
    const auto json = JsonScan::of(parts.json.substr(0, end == std::string_view::npos ? 0 : end + 1),
                                   SceneFileLimits::kMostDepth, why);
    if (!json) return refused(why);
    if (const auto found = GltfJudge(*json, parts.buffer, static_cast<double>(bytes.size()), sizeOf).judge())
        return refused(*found);
    return std::nullopt;
}

}  // namespace passung::importer
