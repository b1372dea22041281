/// Readings CSV to closed months, against merely reading and splitting the same file.
///
///   ingest_bench [readings]        default 1,000,000; the long file has ten times as many
///
/// Prints both times, their ratio (target: at most 3), readings a second on one core (target: at
/// least a million), and how far the largest resident memory grows from the short to the long file.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/csv/readings_csv.hpp"
#include "core/metering/months/month_closer.hpp"
#include "core/random/rng.hpp"

namespace {

using recald::Rng;
using namespace recald::metering;
namespace csv = recald::csv;

constexpr std::size_t kMeters = 10;
constexpr int kTurns = 15;

std::string meter_name(std::size_t meter) { return "meter-" + std::to_string(meter); }

/// Ten meters, every quarter of an hour, ordered by time, 1 % of the rows absent.
std::uint64_t write_file(const std::filesystem::path& path, std::uint64_t readings) {
  Rng rng{1};
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) std::exit(1);
  std::fputs("timestamp,meter,value,unit\n", file);
  Instant t = std::chrono::sys_days{
      Day{std::chrono::year{2010}, std::chrono::month{1}, std::chrono::day{1}}};
  std::uint64_t written = 0;
  while (written < readings) {
    const std::string stamp = to_string(t);
    for (std::size_t meter = 0; meter < kMeters; ++meter) {
      if (rng.below(100) == 0) continue;
      const double hour = static_cast<double>((t.time_since_epoch().count() % 86'400) / 900);
      const double value_kW = 40.0 + hour + rng.uniform(0.0, 30.0);
      std::fprintf(file, "%s,%s,%.3f,kW\n", stamp.c_str(), meter_name(meter).c_str(), value_kW);
      ++written;
    }
    t += std::chrono::minutes{15};
    // Instants end with the known years.
    if (t >= kLatestInstant - std::chrono::days{1}) break;
  }
  std::fclose(file);
  return written;
}

/// The bare minimum: every byte read, every line cut into fields, nothing understood.
std::uint64_t split_file(const std::filesystem::path& path) {
  std::vector<char> buffer(256 * 1024);
  std::array<std::string_view, 16> fields;
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) std::exit(1);
  std::setvbuf(file, nullptr, _IONBF, 0);
  std::uint64_t total = 0;
  std::size_t kept = 0;
  for (;;) {
    const std::size_t got = std::fread(buffer.data() + kept, 1, buffer.size() - kept, file);
    if (got == 0) break;
    const char* line = buffer.data();
    const char* const end = buffer.data() + kept + got;
    while (const auto* newline = static_cast<const char*>(
               std::memchr(line, '\n', static_cast<std::size_t>(end - line)))) {
      std::size_t count = 0;
      const char* field = line;
      while (const auto* comma = static_cast<const char*>(
                 std::memchr(field, ',', static_cast<std::size_t>(newline - field)))) {
        fields[count++ % fields.size()] = {field, static_cast<std::size_t>(comma - field)};
        field = comma + 1;
      }
      fields[count++ % fields.size()] = {field, static_cast<std::size_t>(newline - field)};
      benchmark::DoNotOptimize(fields);
      total += count;
      line = newline + 1;
    }
    kept = static_cast<std::size_t>(end - line);
    std::memmove(buffer.data(), line, kept);
  }
  std::fclose(file);
  return total;
}

struct Ingested {
  std::uint64_t readings = 0;
  std::uint64_t months = 0;
  double energy_kWh = 0.0;
};

Ingested ingest_file(const std::filesystem::path& path, const LocalCalendar& calendar) {
  csv::ReadingsOptions options;
  std::vector<Meter> meters(kMeters);
  for (std::size_t i = 0; i < kMeters; ++i) {
    meters[i].id = meter_name(i);
    options.meters.push_back({});
    options.meters.back().name = meter_name(i);
  }
  Ingested ingested;
  MonthCloser closer{calendar, meters, {}, [&](ClosedMonth&& month) {
                       ++ingested.months;
                       ingested.energy_kWh += month.figure.daily_average_kWh;
                     }};
  csv::ReadingsSink sink;
  sink.on_meter = [&](const csv::MeterInFile& shown) {
    closer.set_grid(shown.meter, shown.interval, shown.phase);
  };
  sink.on_reading = [&](const Reading& reading) { closer.add(reading); };
  const auto report = csv::read_readings(path, options, sink);
  if (!report) std::exit(1);
  closer.finish();
  ingested.readings = report->readings;
  return ingested;
}

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Processor time: what other programs take from the machine is not ours.
template <class Work>
double seconds_of(Work work) {
  const double begin = processor_seconds();
  work();
  return processor_seconds() - begin;
}

long largest_resident_kB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t wanted = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1'000'000;
  std::array<char, 64> pattern{};
  std::snprintf(pattern.data(), pattern.size(), "%s/recald-ingest-XXXXXX",
                std::filesystem::temp_directory_path().c_str());
  if (mkdtemp(pattern.data()) == nullptr) return 1;
  const std::filesystem::path folder = pattern.data();
  const auto calendar = LocalCalendar::open("America/Chicago");
  if (!calendar) return 1;

  const std::uint64_t written = write_file(folder / "short.csv", wanted);
  std::uint64_t fields = 0;
  Ingested ingested;
  // Turn by turn, so that both meet the same machine; the best of each is the least disturbed.
  double split_s = 1e9;
  double ingest_s = 1e9;
  for (int turn = 0; turn < kTurns; ++turn) {
    split_s = std::min(split_s, seconds_of([&] { fields = split_file(folder / "short.csv"); }));
    ingest_s = std::min(
        ingest_s, seconds_of([&] { ingested = ingest_file(folder / "short.csv", *calendar); }));
  }
  const long short_kB = largest_resident_kB();
  const std::uint64_t long_written = write_file(folder / "long.csv", 10 * wanted);
  const Ingested long_ingested = ingest_file(folder / "long.csv", *calendar);
  const long long_kB = largest_resident_kB();
  std::filesystem::remove_all(folder);

  std::printf(
      "readings            %llu in, %llu through, %llu months, %llu fields\n",
      static_cast<unsigned long long>(written), static_cast<unsigned long long>(ingested.readings),
      static_cast<unsigned long long>(ingested.months), static_cast<unsigned long long>(fields));
  std::printf("read and split      %.4f s of processor\n", split_s);
  std::printf("csv to months       %.4f s of processor, %.2f million readings/s\n", ingest_s,
              static_cast<double>(ingested.readings) / ingest_s / 1e6);
  std::printf("ratio               %.2f\n", ingest_s / split_s);
  std::printf("memory              %ld kB after %llu readings, %ld kB after %llu\n", short_kB,
              static_cast<unsigned long long>(ingested.readings), long_kB,
              static_cast<unsigned long long>(long_ingested.readings));
  return ingested.readings == written && long_ingested.readings == long_written ? 0 : 1;
}
