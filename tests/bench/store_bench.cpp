/// A year of ten meters through the store, against inserting the same rows with SQLite and nothing
/// else.
///
///   store_bench
///
/// Prints processor and wall seconds (targets: 10 s on disk, 2 s in memory) and the ratio to bare
/// inserts, turn by turn so that all meet the same machine.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "adapters/sqlite/sqlite_store.hpp"

namespace {

using namespace recald;
using metering::Instant;

constexpr std::uint32_t kMeters = 10;
constexpr int kDays = 365;
constexpr int kQuarters = 96;
constexpr int kTurns = 3;
const Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 1 / 1};

double clock_s(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Times {
  double wall_s = 1e9;
  double processor_s = 1e9;
};

template <class Work>
void best_of(Times& best, Work work) {
  const double wall = clock_s(CLOCK_MONOTONIC);
  const double processor = clock_s(CLOCK_PROCESS_CPUTIME_ID);
  work();
  best.wall_s = std::min(best.wall_s, clock_s(CLOCK_MONOTONIC) - wall);
  best.processor_s = std::min(best.processor_s, clock_s(CLOCK_PROCESS_CPUTIME_ID) - processor);
}

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

}  // namespace

int main() {
  std::string pattern = (std::filesystem::temp_directory_path() / "recald-store-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) return 1;
  const std::filesystem::path folder = pattern;
  Times bare;
  Times memory;
  Times disk;
  for (int turn = 0; turn < kTurns; ++turn) {
    best_of(bare, bare_inserts);
    best_of(memory, [] { year(":memory:", 1); });
    best_of(disk, [&] { year(folder / (std::to_string(turn) + ".db"), kQuarters); });
  }
  std::filesystem::remove_all(folder);
  const auto line = [&](const char* what, const Times& times) {
    std::printf("%-34s %6.2f s, %6.2f s of processor, ratio %.2f\n", what, times.wall_s,
                times.processor_s, times.processor_s / bare.processor_s);
  };
  line("bare inserts", bare);
  line("in memory, a commit a quarter hour", memory);
  line("on disk, a commit a day", disk);
  return 0;
}
