#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "core/import/mesh_formats.h"
#include "core/import/text_scanner.h"

namespace passung::importer {

namespace {

enum class Format { Text, LittleEndian, BigEndian };
enum class Type { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

constexpr std::array<std::size_t, 8> kBytes{1, 1, 2, 2, 4, 4, 4, 8};

std::optional<Type> typeNamed(std::string_view name) {
    constexpr std::array<std::array<std::string_view, 2>, 8> kNames{{{"char", "int8"},
                                                                     {"uchar", "uint8"},
                                                                     {"short", "int16"},
                                                                     {"ushort", "uint16"},
                                                                     {"int", "int32"},
                                                                     {"uint", "uint32"},
                                                                     {"float", "float32"},
                                                                     {"double", "float64"}}};
    for (std::size_t i = 0; i < kNames.size(); ++i)
        if (name == kNames[i][0] || name == kNames[i][1]) return static_cast<Type>(i);
    return std::nullopt;
}

struct Property {
    std::string name;
    std::optional<Type> count;  // of a list
    Type type = Type::Float32;
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

struct Head {
    Format format = Format::Text;
    std::vector<Element> elements;
};

Result<Property> readProperty(TextScanner& text) {
    Property property;
    std::string_view word = text.word();
    if (word == "list") {
        word = text.word();
        property.count = typeNamed(word);
        if (!property.count || *property.count >= Type::Float32) return text.error("must be a whole type", word);
        word = text.word();
    }
    const auto type = typeNamed(word);
    if (!type) return text.error("must be a type: char, uchar, short, ushort, int, uint, float or double", word);
    property.type = *type;
    property.name = text.word();
    return property;
}

Result<Head> readHead(TextScanner& text) {
    Head head;
    if (!text.nextLine(0) || text.word() != "ply") return text.error("must begin with ply");
    bool has_format = false;
    while (text.nextLine(0)) {
        const std::string_view keyword = text.word();
        if (keyword == "end_header") {
            if (!has_format) return text.error("the head must name a format");
            return head;
        }
        if (keyword == "format") {
            const std::string_view format = text.word();
            if (format == "ascii")
                head.format = Format::Text;
            else if (format == "binary_little_endian")
                head.format = Format::LittleEndian;
            else if (format == "binary_big_endian")
                head.format = Format::BigEndian;
            else
                return text.error("the format must be ascii, binary_little_endian or binary_big_endian", format);
            has_format = true;
        } else if (keyword == "element") {
            Element element;
            element.name = text.word();
            const std::string_view word = text.word();
            const auto count = numberIn<std::uint64_t>(word);
            if (!count || *count >= 0xffffffffu) return text.error("must be the number of elements", word);
            element.count = *count;
            head.elements.push_back(std::move(element));
        } else if (keyword == "property") {
            if (head.elements.empty()) return text.error("a property must follow its element");
            auto property = readProperty(text);
            if (!property) return property.errors();
            head.elements.back().properties.push_back(std::move(*property));
        } else if (keyword != "comment" && keyword != "obj_info") {
            return text.error("must be one of format, comment, element, property, end_header", keyword);
        }
    }
    return text.error("the file ends within its head");
}

/// The numbers behind the head, one after the other.
class Numbers {
public:
    Numbers(TextScanner text, Format format) : text_(std::move(text)), format_(format), bytes_(text_.rest()) {}

    /// Not finite at the end of the file and where a word is no number.
    double next(Type type) {
        if (format_ == Format::Text) {
            std::string_view word = text_.word();
            if (word.empty() && text_.nextLine(0)) word = text_.word();
            ended_ = word.empty();
            return coordinateIn(word).value_or(NAN);
        }
        const std::size_t size = kBytes[static_cast<std::size_t>(type)];
        if (bytes_.size() < size) {
            ended_ = true;
            return NAN;
        }
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t at = format_ == Format::LittleEndian ? size - 1 - i : i;
            bits = bits << 8 | static_cast<unsigned char>(bytes_[at]);
        }
        bytes_.remove_prefix(size);
        switch (type) {
            case Type::Int8:
                return static_cast<double>(static_cast<std::int8_t>(bits));
            case Type::Int16:
                return static_cast<double>(static_cast<std::int16_t>(bits));
            case Type::Int32:
                return static_cast<double>(static_cast<std::int32_t>(bits));
            case Type::Float32:
                return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
            case Type::Float64:
                return std::bit_cast<double>(bits);
            default:
                return static_cast<double>(bits);
        }
    }

    bool ended() const { return ended_; }

    Error error(const Element& element, std::uint64_t index, const std::string& message) const {
        Error error = format_ == Format::Text ? text_.error("") : TextScanner({}, "").error("");
        error.key = element.name + " " + std::to_string(index);
        error.message = ended_ ? "the file ends here; its head promises " + std::to_string(element.count) : message;
        return error;
    }

private:
    TextScanner text_;
    Format format_;
    std::string_view bytes_;
    bool ended_ = false;
};

bool isWhole(double number, double end) { return number >= 0.0 && number < end && number == std::floor(number); }

Result<Done> readElement(Numbers& numbers, const Element& element, geometry::TriangleMesh& mesh) {
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    if (element.properties.empty()) return Done{};
    std::vector<std::uint32_t> corners;
    for (std::uint64_t i = 0; i < element.count; ++i) {
        Vec3 v = Vec3::Zero();
        for (const Property& property : element.properties) {
            std::uint64_t count = 1;
            if (property.count) {
                const double stated = numbers.next(*property.count);
                if (!isWhole(stated, 4294967295.0))
                    return numbers.error(element, i, "the length of a list must be whole");
                count = static_cast<std::uint64_t>(stated);
            }
            const bool names_corners =
                is_face && property.count && (property.name == "vertex_indices" || property.name == "vertex_index");
            corners.clear();
            if (names_corners && count > kMostPolygonCorners) return numbers.error(element, i, kTooManyCorners);
            for (std::uint64_t k = 0; k < count; ++k) {
                const double number = numbers.next(property.type);
                if (names_corners) {
                    if (!isWhole(number, static_cast<double>(mesh.vertices.size())))
                        return numbers.error(element, i,
                                             "must name vertices that stand before the faces, of " +
                                                 std::to_string(mesh.vertices.size()));
                    corners.push_back(static_cast<std::uint32_t>(number));
                } else if (is_vertex && !property.count && property.name.size() == 1 && property.name[0] >= 'x' &&
                           property.name[0] <= 'z') {
                    if (!std::isfinite(number)) return numbers.error(element, i, "every coordinate must be finite");
                    v[property.name[0] - 'x'] = number;
                } else if (numbers.ended()) {
                    return numbers.error(element, i, "");
                }
            }
            if (names_corners && corners.size() >= 3) addPolygon(mesh, corners);
        }
        if (is_vertex) mesh.vertices.push_back(v);
    }
    return Done{};
}

}  // namespace

Result<geometry::TriangleMesh> readPly(std::string_view bytes, const std::string& file) {
    TextScanner text(bytes, file);
    const auto head = readHead(text);
    if (!head) return head.errors();
    geometry::TriangleMesh mesh;
    Numbers numbers(text, head->format);
    for (const Element& element : head->elements) {
        if (auto read = readElement(numbers, element, mesh); !read) {
            Error error = read.errors()[0];
            error.file = file;
            return error;
        }
    }
    return mesh;
}

}  // namespace passung::importer
