#pragma once

#include <string>
#include <string_view>

namespace passung::exporter {

/// A gzip file of `text` without name or time stamp: the same text gives the same bytes.
std::string gzip(std::string_view text);

}  // namespace passung::exporter
