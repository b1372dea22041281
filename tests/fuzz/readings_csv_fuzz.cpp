// Readings are on their grid, finite or blank, and counted; written as a plain file they are read
// the same again. Every line that is kept out has its reason.
#include <charconv>
#include <cmath>
#include <vector>

#include "adapters/csv/readings_csv.hpp"
#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

using csv::MeterInFile;
using csv::ReadingsOptions;
using csv::ReadingsReport;
using metering::Reading;

struct Read {
  std::vector<MeterInFile> meters;  // in order of appearance
  std::vector<Reading> readings;
};

Result<ReadingsReport> read(std::string_view text, const ReadingsOptions& options, Read& into) {
  return csv::read_readings_text(
      text, "readings.csv", options,
      {.on_meter = [&](const MeterInFile& meter) { into.meters.push_back(meter); },
       .on_reading = [&](const Reading& reading) { into.readings.push_back(reading); }});
}

const MeterInFile& meter_of(const Read& read, const Reading& reading) {
  for (const MeterInFile& meter : read.meters) {
    if (meter.meter == reading.meter) return meter;
  }
  give_up("a meter is told before its readings");
}

void require_sound(const Read& read, const ReadingsReport& report) {
  require(report.readings == read.readings.size(), "readings are counted");
  for (const Reading& reading : read.readings) {
    const MeterInFile& meter = meter_of(read, reading);
    require(!std::isinf(reading.mean_kW), "a reading is finite or blank");
    require((reading.start.time_since_epoch() - meter.phase) % meter.interval ==
                std::chrono::seconds{0},
            "a reading is on its grid");
    require(reading.start + meter.interval <= metering::kLatestInstant,
            "a reading of the known years");
  }
  for (const csv::LineIssue& issue : report.issues.listed) require_sentence(issue.reason);
  require(report.issues.total >= report.issues.listed.size(), "issues are counted");
}

std::string written(const Read& read) {
  std::string text = "timestamp,meter,value,unit\n";
  for (const Reading& reading : read.readings) {
    char value[32] = "";
    char* end = value;
    if (!std::isnan(reading.mean_kW)) {
      end = std::to_chars(value, value + sizeof value, reading.mean_kW).ptr;
    }
    text += metering::to_string(reading.start) + ",m" + std::to_string(reading.meter) + "," +
            std::string{value, end} + ",kW\n";
  }
  return text;
}

void require_same_again(const Read& first) {
  ReadingsOptions options;
  std::uint32_t meters = 0;
  for (const MeterInFile& meter : first.meters) meters = std::max(meters, meter.meter + 1);
  for (std::uint32_t i = 0; i < meters; ++i) {
    options.meters.push_back({.name = "m" + std::to_string(i)});
    for (const MeterInFile& meter : first.meters) {
      if (meter.meter == i) options.meters.back().interval = meter.interval;
    }
  }
  Read again;
  const auto report = read(written(first), options, again);
  require(report.has_value(), "a plain file is read");
  require(again.readings.size() == first.readings.size(), "as many readings again");
  double sum = 0.0;
  double sum_again = 0.0;
  // Meters are handed on one after the other where files are short, so order is the meter's own.
  for (std::uint32_t i = 0; i < meters; ++i) {
    for (const Reading& reading : first.readings) {
      if (reading.meter == i && !std::isnan(reading.mean_kW)) sum += reading.mean_kW;
    }
    for (const Reading& reading : again.readings) {
      if (reading.meter == i && !std::isnan(reading.mean_kW)) sum_again += reading.mean_kW;
    }
  }
  require(sum == sum_again || (std::isnan(sum) && std::isnan(sum_again)), "the same values again");
}

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald::fuzz;
  Input input{data, size};
  const int kind = input.below(8);
  ReadingsOptions options{.add_unlisted_meters = true};
  const auto stamps = (kind & 1) != 0 ? recald::csv::Stamps::end : recald::csv::Stamps::start;
  options.meters.push_back({.name = "main", .stamps = stamps});
  if ((kind & 2) != 0) options.meters.front().interval = std::chrono::seconds{900};
  if ((kind & 4) != 0) {
    options.meters.front().counter = recald::metering::CounterSettings{
        .rated_kW = 400.0, .resolution_kWh = 0.1, .modulus_kWh = 1e8};
  }
  Read first;
  const auto report = read(text_of(input.rest(), input.left()), options, first);
  if (!report) {
    require_sentence(report.error().message);
    return 0;
  }
  require_sound(first, *report);
  require_same_again(first);
  return 0;
}
