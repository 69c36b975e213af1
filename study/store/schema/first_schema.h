#pragma once

namespace passung::store {

/// The SQL of revision 1, on which every later one builds.
extern const char* const kFirstSchema;

}  // namespace passung::store
