/// A year of ten meters through the store, against inserting the same rows with SQLite and nothing
/// else.
///
/// `ratio_to_bare` is the quotient of processor times, taken in turns so that both meet the same
/// machine. Targets for the time of a year: 10 s on disk, 2 s in memory.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>

#include "adapters/sqlite/sqlite_store.hpp"

namespace {

using namespace recald;
using metering::Instant;

constexpr std::uint32_t kMeters = 10;
constexpr int kDays = 365;
constexpr int kQuarters = 96;
const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 1 / 1};

double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double load_kW(int day, int quarter, std::uint32_t meter) {
  return 20.0 + meter + 0.01 * ((day * 37 + quarter * 11) % 1000);
}

void bare_inserts() {
  auto database = sqlite::Database::open(":memory:", {}).value();
  const auto made = database.execute(
      "CREATE TABLE t (a INTEGER, b INTEGER, c INTEGER, d REAL, e INTEGER, f INTEGER, g INTEGER, "
      "PRIMARY KEY (a, b, c)) WITHOUT ROWID; BEGIN");
  auto insert = database.prepare("INSERT INTO t VALUES (?, ?, 0, ?, 0, 0, 0)").value();
  for (int day = 0; day < kDays; ++day) {
    for (int quarter = 0; quarter < kQuarters; ++quarter) {
      for (std::uint32_t meter = 0; meter < kMeters; ++meter) {
        const auto t = std::int64_t{day} * 86'400 + quarter * 900;
        insert.bind(0, std::int64_t{meter}).bind(1, t).bind(2, load_kW(day, quarter, meter));
        if (!insert.run()) std::exit(1);
      }
    }
  }
  if (!made || !database.execute("COMMIT")) std::exit(1);
}

/// @param quarters_a_commit  1 as a live gateway does, 96 as a replay may.
void year(const std::filesystem::path& file, int quarters_a_commit) {
  auto store = sqlite::SqliteStore::open(file).value();
  for (std::uint32_t meter = 0; meter < kMeters; ++meter) {
    (void)store.meter_number("meter-" + std::to_string(meter), std::chrono::minutes{15});
  }
  StoreBatch batch;
  for (int quarter = 0; quarter < kDays * kQuarters; ++quarter) {
    const Instant start = kStart + quarter * std::chrono::minutes{15};
    for (std::uint32_t meter = 0; meter < kMeters; ++meter) {
      batch.intervals.push_back(
          {{meter, start, load_kW(quarter / kQuarters, quarter % kQuarters, meter)}});
    }
    if ((quarter + 1) % quarters_a_commit != 0) continue;
    for (std::uint32_t meter = 0; meter < kMeters; ++meter) {
      batch.registers.push_back({meter, {.field = "energy", .settings = {.rated_kW = 100.0}}});
      batch.registers.back().state.book.next = start;
    }
    if (!store.commit(batch)) std::exit(1);
    batch = {};
  }
}

/// A year a turn, and as many bare inserts untimed beside it.
template <class Year>
void against_bare(benchmark::State& state, Year year_of_turn) {
  double bare_s = 0.0;
  double store_s = 0.0;
  int turn = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const double begin = processor_s();
    bare_inserts();
    bare_s += processor_s() - begin;
    state.ResumeTiming();
    const double before = processor_s();
    year_of_turn(turn++);
    store_s += processor_s() - before;
  }
  state.counters["ratio_to_bare"] = store_s / bare_s;
}

void in_memory_a_commit_a_quarter_hour(benchmark::State& state) {
  against_bare(state, [](int) { year(":memory:", 1); });
}
BENCHMARK(in_memory_a_commit_a_quarter_hour)->Unit(benchmark::kSecond)->Iterations(3);

void on_disk_a_commit_a_day(benchmark::State& state) {
  std::string pattern = (std::filesystem::temp_directory_path() / "recald-store-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) {
    state.SkipWithError("no temporary folder");
    return;
  }
  const std::filesystem::path folder = pattern;
  against_bare(state, [&](int turn) { year(folder / (std::to_string(turn) + ".db"), kQuarters); });
  std::filesystem::remove_all(folder);
}
BENCHMARK(on_disk_a_commit_a_day)->Unit(benchmark::kSecond)->UseRealTime()->Iterations(3);

}  // namespace

BENCHMARK_MAIN();
