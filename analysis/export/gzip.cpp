#include "analysis/export/gzip.h"

#include <zlib.h>

#include <array>
#include <stdexcept>

namespace passung::exporter {
namespace {

constexpr int kLevel = 1;             // samples are noise-like: level 6 takes eight times as long for 8 % less
constexpr int kGzipWindow = 15 + 16;  // zlib: largest window, gzip header
constexpr int kMemory = 8;

}  // namespace

std::string gzip(std::string_view text) {
    z_stream stream = {};
    if (deflateInit2(&stream, kLevel, Z_DEFLATED, kGzipWindow, kMemory, Z_DEFAULT_STRATEGY) != Z_OK) {
        throw std::runtime_error("zlib cannot start");
    }
    gz_header header = {};
    header.os = 255;  // unknown: the same on every system
    deflateSetHeader(&stream, &header);
    std::string packed(deflateBound(&stream, static_cast<uLong>(text.size())), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    const int result = deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    if (result != Z_STREAM_END) throw std::runtime_error("zlib could not pack the samples");
    return packed;
}

}  // namespace passung::exporter
