// A feed that is accepted has readings in order of time, each of a meter that is described and
// within the years that recald knows; a refused one is told why.
#include <cmath>

#include "adapters/table/green_button.hpp"
#include "tests/fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald;
  const auto feed = table::parse_green_button(csv::bytes_of(fuzz::text_of(data, size)));
  if (!feed) {
    fuzz::require_sentence(feed.error().message);
    return 0;
  }
  fuzz::require(!feed->readings.empty(), "a feed has readings");
  metering::Instant last{};
  for (const table::FeedReading& reading : feed->readings) {
    fuzz::require(reading.meter < feed->meters.size(), "a reading is of a meter");
    fuzz::require(last <= reading.start && reading.start < metering::kLatestInstant,
                  "readings come in order of time");
    fuzz::require(!std::isinf(reading.value), "a value is finite or blank");
    last = reading.start;
  }
  return 0;
}
