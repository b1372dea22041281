/// The real program, killed with SIGKILL at random moments while it polls a real socket.
///
/// RECALD_REAL_KILLS: how often, 12 unless set.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "adapters/stores/open.hpp"
#include "core/random/rng.hpp"
#include "daemon/gateway/upkeep/open_store.hpp"
#include "tests/daemon/gateway/run/polled_site.hpp"
#include "tests/support/background_process.hpp"
#include "tests/support/seed.hpp"

namespace recald::daemon::kill_command_test {
namespace {

using metering::Instant;
using recald::testing::BackgroundProcess;
using recald::testing::eventually;

class KillCommand : public recald::testing::PolledSite {
 protected:
  /// Samples of the register that a reader beside the daemon sees committed.
  [[nodiscard]] std::map<Instant, double> committed() const {
    std::map<Instant, double> samples;
    if (!std::filesystem::exists(folder_ / "site.db")) return samples;
    const auto store = stores::open_to_read(folder_ / "site.db");
    if (!store) return samples;
    const auto read = (*store)->for_each_sample(
        0, "energy",
        [&](const metering::RegisterSample& one) { samples[one.time] = one.value_kWh; });
    EXPECT_TRUE(read.has_value()) << read.error().message;
    return samples;
  }
};

/// A register that rises with each read was read once before an interval's bound and once after it:
/// what all intervals add up to lies between.
/// @param samples  In kWh by time, of the whole life of the register.
void expect_energy(Store& store, const std::map<Instant, double>& samples) {
  constexpr std::chrono::minutes kInterval{1};
  double sum_kWh = 0.0;
  std::optional<Instant> begin;
  std::optional<Instant> end;
  const auto read = store.for_each_interval(0, {Instant::min(), Instant::max()},
                                            [&](const StoredInterval& interval) {
                                              const metering::Reading& reading = interval.reading;
                                              if (!begin) begin = reading.start;
                                              if (end) {
                                                EXPECT_EQ(reading.start, *end);
                                              }
                                              end = reading.start + kInterval;
                                              sum_kWh += reading.mean_kW / 60.0;
                                            });
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_TRUE(begin.has_value());
  const auto after_begin = samples.lower_bound(*begin);
  const auto after_end = samples.lower_bound(*end);
  ASSERT_NE(after_end, samples.end());
  // The first read may fall on the bound itself, one time in sixty.
  const bool is_on_bound = after_begin->first == *begin;
  ASSERT_TRUE(is_on_bound || after_begin != samples.begin());
  const double before_begin_kWh =
      is_on_bound ? after_begin->second : std::prev(after_begin)->second;
  constexpr double kRounding_kWh = 1e-9;
  EXPECT_GE(sum_kWh, std::prev(after_end)->second - after_begin->second - kRounding_kWh);
  EXPECT_LE(sum_kWh, after_end->second - before_begin_kWh + kRounding_kWh);
}

TEST_F(KillCommand, KillsOfTheRealProgramLoseNothing) {
  const int kills = recald::testing::given_or("RECALD_REAL_KILLS", 12);
  const std::filesystem::path said = folder_ / "said.txt";
  const std::vector<std::string> command{RECALD_PROGRAM, "run", (folder_ / "site.toml").string()};
  const recald::testing::Seed seed;
  Rng rng{seed.value()};
  std::map<Instant, double> seen;
  const auto has_interval = [&] {
    const auto store = stores::open_to_read(folder_ / "site.db");
    return store && (*store)->interval_extent(0).value_or(std::nullopt).has_value();
  };
  for (int kill = 0; kill < kills || !has_interval(); ++kill) {
    SCOPED_TRACE(fmt::format("kill {}", kill));
    BackgroundProcess daemon{command, said};
    const int requests = server_.requests() + 1 + static_cast<int>(rng.below(8));
    ASSERT_TRUE(eventually([&] { return server_.requests() >= requests; }))
        << recald::testing::read_text(said);
    const auto before = committed();
    EXPECT_EQ(daemon.end(SIGKILL), -SIGKILL);
    const auto after = committed();
    EXPECT_TRUE(std::ranges::includes(after, before));
    EXPECT_TRUE(std::ranges::includes(after, seen));
    seen = after;
  }
  EXPECT_GE(seen.size(), static_cast<std::size_t>(kills));
  // The register rises with each read, so a sample that stood twice would be seen.
  std::set<double> values;
  for (const auto& [time, value_kWh] : seen) EXPECT_TRUE(values.insert(value_kWh).second);
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  const auto opened = open_store(default_store(folder_ / "site.toml"), now).value();
  EXPECT_EQ(opened.recovery, "");
  EXPECT_EQ(opened.store->check().value().damage, "");
  expect_energy(*opened.store, seen);
}

}  // namespace
}  // namespace recald::daemon::kill_command_test
