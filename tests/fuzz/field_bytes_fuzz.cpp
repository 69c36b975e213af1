#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/field/distance_field.h"
#include "core/scene/build_store.h"
#include "core/shell/shell_bytes.h"

/// libFuzzer: any bytes are a field, a shell, or nothing; a field that is one answers queries. The checksum is left
/// out: no mutation would pass it. An input that begins with 'e' is a list of edits of a sound field (four bytes:
/// where, one: what is turned there), with 't' the same, cut off where the first four bytes say; any other is read as
/// it stands.
namespace {

using namespace passung;
using namespace passung::field;

std::string soundBytes() {
    DistanceSource source;
    source.bounds.extend(Vec3::Constant(-1.0));
    source.bounds.extend(Vec3::Constant(1.0));
    source.distance = [](const Vec3& p) { return std::abs(p.norm() - 1.0); };
    source.inside = [](const Vec3& p) { return p.norm() < 1.0; };
    source.closed = true;
    FieldAccuracy accuracy;
    accuracy.tolerance = 0.01;
    const auto field = DistanceField::build(source, 0.25, 0.25, accuracy);
    if (!field) std::abort();
    return field->toBytes();
}

std::uint32_t word(std::string_view bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

std::string edited(std::string_view edits) {
    static const std::string kSound = soundBytes();
    std::string bytes = kSound;
    if (edits.size() >= 5 && edits[0] == 't') {
        bytes.resize(word(edits.substr(1)) % bytes.size());
        edits.remove_prefix(4);
    }
    for (edits.remove_prefix(1); edits.size() >= 5 && !bytes.empty(); edits.remove_prefix(5)) {
        // Half of the edits go to the head, where counts and sizes are.
        const std::uint32_t where = word(edits);
        const std::size_t at =
            (where & 1u) != 0 ? (where >> 1) % std::min<std::size_t>(200, bytes.size()) : (where >> 1) % bytes.size();
        bytes[at] = static_cast<char>(bytes[at] ^ edits[4]);
    }
    return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string_view given(reinterpret_cast<const char*>(data), size);
    (void)scene::unsealed("key", given);
    (void)shell::shellFrom(given);
    const bool edits = !given.empty() && (given[0] == 'e' || given[0] == 't');
    const auto field = edits ? DistanceField::fromBytes(edited(given)) : DistanceField::fromBytes(given);
    if (!field) return 0;
    const Vec3 low = field->bounds().low, high = field->bounds().high;
    for (int i = -2; i <= 6; ++i) {
        const Vec3 p = low + 0.25 * i * (high - low);
        (void)field->lowerBound(p);
        for (const FieldMode mode : kFieldModes) {
            (void)field->sample(p, mode, Vec3::UnitX());
            (void)field->errorBound(p, mode);
        }
    }
    return 0;
}
