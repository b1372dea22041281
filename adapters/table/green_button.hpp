/// Green Button feeds: interval readings of a utility's portal (NAESB ESPI XML).
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adapters/csv/line_reader.hpp"
#include "adapters/table/row_source.hpp"
#include "core/metering/reading.hpp"

namespace recald::table {

/// One meter reading of a feed, as its reading type describes it.
struct FeedMeter {
  std::string name;   ///< "UsagePoint/1/MeterReading/2", as its link has it.
  std::string title;  ///< In words; often empty.
  std::optional<metering::Utility> utility;
  std::string unit;          ///< "Wh", "m3"; "uom 5" for what is no energy.
  bool is_register = false;  ///< A cumulative register, not amounts of intervals.
  bool is_reverse = false;   ///< What the building gives back.
  std::optional<std::chrono::seconds> interval;
};

struct FeedReading {
  metering::Instant start;
  std::uint32_t meter;  ///< In `Feed::meters`.
  double value;         ///< In its unit, the power of ten applied.
};

struct Feed {
  std::vector<FeedMeter> meters;      ///< Those that have readings, in order of appearance.
  std::vector<FeedReading> readings;  ///< In order of time: feeds may begin with the newest.
};

/// Reads a feed as a whole, up to four million readings.
/// @return malformed: no ESPI feed, a reading that is no number, one outside 1971…2037.
[[nodiscard]] Result<Feed> parse_green_button(csv::ByteSource bytes);

/// The same of a file; messages name it.
[[nodiscard]] Result<Feed> read_green_button(const std::filesystem::path& file);

/// Its readings as rows of timestamp, meter, value, unit.
[[nodiscard]] std::unique_ptr<RowSource> feed_rows(Feed feed);

[[nodiscard]] Result<std::unique_ptr<RowSource>> open_green_button(
    const std::filesystem::path& file);

}  // namespace recald::table
