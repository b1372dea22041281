/// JSON of portals and interfaces as rows: a list of readings, wherever in the document it stands.
#pragma once

#include <functional>
#include <memory>

#include "adapters/csv/line_reader.hpp"
#include "adapters/table/row_source.hpp"

namespace recald::table {

/// The longest list of objects, or of lists, in a document is its readings, as are lists of equal
/// length beside each other, and documents line by line. Each gives a row; its columns are called
/// by their keys: "value", "quality.code" in an object within, "item 2" in a list. What stands in
/// the objects around it, such as a meter or a unit, comes as further columns: "meter.unit".
/// @param open  Opens the text; called twice. Up to 512 MiB and four million readings.
/// @return the rows; or malformed: no JSON, nested more than 64 deep, no list of readings, too
/// long.
[[nodiscard]] Result<std::unique_ptr<RowSource>> json_rows(
    const std::function<Result<csv::ByteSource>()>& open);

}  // namespace recald::table
