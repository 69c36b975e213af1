#pragma once

#include "study/plan/view.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {

/// [view] of the study `root`.
plan::View readView(const TableReader& root, Errors& errors);

}  // namespace passung::protocol
