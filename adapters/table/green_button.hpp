/// Green Button feeds: interval readings from a utility's portal (NAESB ESPI XML).
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
  std::string name;   ///< "UsagePoint/1/MeterReading/2", as in its link.
  std::string title;  ///< In words; often empty.
  std::optional<metering::Utility> utility;
  std::string unit;          ///< "Wh", "m3"; "uom 5" if it is not energy.
  bool is_register = false;  ///< A cumulative register, not amounts of intervals.
  bool is_reverse = false;   ///< Energy that the building exports.
  std::optional<std::chrono::seconds> interval;
  int tariff = 0;  ///< Time-of-use register; 0: the total.
};

struct FeedReading {
  metering::Instant start;
  std::uint32_t meter;   ///< In `Feed::meters`.
  std::uint8_t quality;  ///< As ESPI counts them; 0, valid, where the feed does not say.
  double value;          ///< In the meter's unit, the power of ten applied.
};

struct Feed {
  std::vector<FeedMeter> meters;      ///< Meters with readings, in order of appearance.
  std::vector<FeedReading> readings;  ///< In order of time; feeds may list the newest first.
};

/// Reads a whole feed, up to four million readings.
/// @return malformed: not an ESPI feed, a reading that is not a number, one outside the known
/// years.
[[nodiscard]] Result<Feed> parse_green_button(csv::ByteSource bytes);

/// As above, for a file; messages name it.
[[nodiscard]] Result<Feed> read_green_button(const std::filesystem::path& file);

/// The feed's readings as rows of timestamp, meter, value, unit.
[[nodiscard]] std::unique_ptr<RowSource> feed_rows(Feed feed);

[[nodiscard]] Result<std::unique_ptr<RowSource>> open_green_button(
    const std::filesystem::path& file);

}  // namespace recald::table
