#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "analysis/export/export.h"
#include "study/store/read/store_reader.h"
#include "study/store/read/verify.h"
#include "tests/study/store/damaged_study.h"

/// libFuzzer: a study's database with any bytes changed or cut off is read, verified and exported, or refused with a
/// message; it is never changed. The input is a list of edits (four bytes: where, one: what is turned there); one that
/// begins with 't' is cut off where the next four bytes say.
namespace {

using namespace passung;

std::string bytesOf(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string soundBytes(const std::string& path) {
    fake::performAsking(path, "S001");
    return bytesOf(path);
}

std::uint32_t word(std::string_view bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

std::string edited(std::string bytes, std::string_view edits) {
    if (edits.size() >= 5 && edits[0] == 't') {
        bytes.resize(word(edits.substr(1)) % bytes.size());
        edits.remove_prefix(5);
    }
    for (; edits.size() >= 5 && !bytes.empty(); edits.remove_prefix(5)) {
        // Half of the edits go to the heads of pages, where counts and places are.
        const std::uint32_t where = word(edits);
        std::size_t at = (where >> 1) % bytes.size();
        if ((where & 1u) != 0) at -= at % 4096 - at % 128;
        bytes[at] = static_cast<char>(bytes[at] ^ edits[4]);
    }
    return bytes;
}

template <class T>
bool told(const Result<T>& result) {
    return result || (!result.errors().empty() && !result.errors()[0].message.empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const test::TempFolder kFolder;
    static const std::string kSound = soundBytes(kFolder / "sound.db");
    const std::string bytes = edited(kSound, {reinterpret_cast<const char*>(data), size});
    const std::string path = kFolder / "study.db";
    std::ofstream(path, std::ios::binary) << bytes;
    if (!told(store::verifyDatabase(path))) std::abort();
    const auto reader = store::StoreReader::open(path, store::Damaged::LeftOut);
    if (!told(reader)) std::abort();
    if (reader) {
        std::filesystem::remove_all(kFolder / "out");
        if (!told(exporter::exportAll(*reader, kFolder / "out", {}))) std::abort();
    }
    if (bytesOf(path) != bytes) std::abort();
    return 0;
}
