#include "core/import/mesh_bytes.h"

#include <array>
#include <cmath>
#include <tuple>
#include <type_traits>
#include <utility>

#include "core/base/bytes.h"

namespace passung::importer {

namespace {

constexpr std::uint64_t kMesh = 1, kErrors = 2;

/// Everything that a report holds besides its texts, in one order for both ways.
template <class Report>
auto fieldsOf(Report& r) {
    return std::tie(r.metres_per_unit, r.triangles_read, r.triangles, r.vertices, r.welded_vertices, r.joined_vertices,
                    r.split_edges, r.degenerate_triangles, r.duplicate_triangles, r.boundary_edges, r.holes,
                    r.non_manifold_edges, r.inconsistent_edges, r.turned_triangles, r.shells, r.turned_patches,
                    r.turned_patch_triangles, r.cavities, r.nested_solids, r.crossing_triangles, r.crossing_pairs,
                    r.watertight, r.turned_inside_out, r.kind, r.closed_holes, r.closed_seams, r.closing_triangles,
                    r.open_edges_left, r.size, r.area, r.volume);
}

class Writer {
public:
    void text(const std::string& value) {
        bytes_.put(value.size(), 8);
        for (const char c : value) bytes_.put(static_cast<unsigned char>(c), 1);
    }
    template <class T>
    void field(const T& value) {
        if constexpr (std::is_same_v<T, double> || std::is_same_v<T, Vec3>)
            bytes_.put(value);
        else
            bytes_.put(static_cast<std::uint64_t>(value), 8);
    }
    void number(std::uint64_t value, int bytes) { bytes_.put(value, bytes); }
    std::string take() { return bytes_.take(); }

private:
    ByteWriter bytes_;
};

class Reader {
public:
    explicit Reader(std::string_view bytes) : bytes_(bytes) {}

    std::string text() {
        std::string value(bytes_.takeCount(1), '\0');
        for (char& c : value) c = static_cast<char>(bytes_.take(1));
        return value;
    }
    template <class T>
    void field(T& value) {
        if constexpr (std::is_same_v<T, double>) {
            value = bytes_.takeDouble();
            sound_ = sound_ && std::isfinite(value);
        } else if constexpr (std::is_same_v<T, Vec3>) {
            value = bytes_.takeVec3();
            sound_ = sound_ && value.allFinite();
        } else {
            const std::uint64_t number = bytes_.take(8);
            constexpr std::uint64_t kKinds = static_cast<std::uint64_t>(SurfaceKind::OpenSheet) + 1;
            if constexpr (std::is_same_v<T, SurfaceKind>) sound_ = sound_ && number < kKinds;
            if constexpr (std::is_same_v<T, bool>) sound_ = sound_ && number < 2;
            if (sound_) value = static_cast<T>(number);
        }
    }
    std::uint64_t number(int bytes) { return bytes_.take(bytes); }
    std::size_t count(std::size_t bytes_each) { return bytes_.takeCount(bytes_each); }
    void require(bool sound) { sound_ = sound_ && sound; }
    bool sound() const { return sound_ && !bytes_.failed(); }
    bool whole() const { return sound() && bytes_.atEnd(); }

private:
    ByteReader bytes_;
    bool sound_ = true;
};

void put(Writer& to, const ImportedMesh& imported) {
    to.number(imported.mesh.vertices.size(), 8);
    for (const Vec3& v : imported.mesh.vertices) to.field(v);
    to.number(imported.mesh.triangles.size(), 8);
    for (const geometry::Triangle& t : imported.mesh.triangles)
        for (const auto corner : t) to.number(corner, 4);
    to.text(imported.report.file);
    to.text(imported.report.format);
    std::apply([&](const auto&... field) { (to.field(field), ...); }, fieldsOf(imported.report));
    to.number(imported.report.notes.size(), 8);
    for (const std::string& note : imported.report.notes) to.text(note);
}

ImportedMesh takeMesh(Reader& from) {
    ImportedMesh imported;
    imported.mesh.vertices.resize(from.count(24));
    for (Vec3& v : imported.mesh.vertices) from.field(v);
    imported.mesh.triangles.resize(from.count(12));
    for (geometry::Triangle& t : imported.mesh.triangles)
        for (auto& corner : t) {
            corner = static_cast<std::uint32_t>(from.number(4));
            from.require(corner < imported.mesh.vertices.size());
        }
    imported.report.file = from.text();
    imported.report.format = from.text();
    std::apply([&](auto&... field) { (from.field(field), ...); }, fieldsOf(imported.report));
    imported.report.notes.resize(from.count(8));
    for (std::string& note : imported.report.notes) note = from.text();
    from.require(!imported.mesh.triangles.empty());
    return imported;
}

void put(Writer& to, const Errors& errors) {
    to.number(errors.size(), 8);
    for (const Error& error : errors) {
        for (const std::string* text : {&error.message, &error.file, &error.key, &error.value}) to.text(*text);
        to.number(static_cast<std::uint64_t>(error.line), 4);
        to.number(static_cast<std::uint64_t>(error.column), 4);
    }
}

Errors takeErrors(Reader& from) {
    Errors errors(from.count(40));
    for (Error& error : errors) {
        for (std::string* text : {&error.message, &error.file, &error.key, &error.value}) *text = from.text();
        error.line = static_cast<int>(from.number(4));
        error.column = static_cast<int>(from.number(4));
    }
    from.require(!errors.empty());
    return errors;
}

}  // namespace

std::string toBytes(const Result<ImportedMesh>& imported) {
    Writer to;
    to.number(imported ? kMesh : kErrors, 1);
    if (imported)
        put(to, *imported);
    else
        put(to, imported.errors());
    return to.take();
}

std::optional<Result<ImportedMesh>> importedFrom(std::string_view bytes) {
    Reader from(bytes);
    const std::uint64_t what = from.number(1);
    if (what == kMesh) {
        ImportedMesh imported = takeMesh(from);
        if (from.whole()) return imported;
    } else if (what == kErrors) {
        Errors errors = takeErrors(from);
        if (from.whole()) return errors;
    }
    return std::nullopt;
}

}  // namespace passung::importer
