/// The real program, killed with SIGKILL at random moments while it polls a real socket.
///
/// RECALD_REAL_KILLS: how often, 12 unless set.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

#include "adapters/stores/open.hpp"
#include "core/random/rng.hpp"
#include "tests/daemon/gateway/run/polled_site.hpp"
#include "tests/support/background_process.hpp"

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

TEST_F(KillCommand, KillsOfTheRealProgramLoseNothing) {
  const char* given = std::getenv("RECALD_REAL_KILLS");
  const int kills = given != nullptr ? std::atoi(given) : 12;
  const std::filesystem::path said = folder_ / "said.txt";
  const std::vector<std::string> command{RECALD_PROGRAM, "run", (folder_ / "site.toml").string()};
  Rng rng{1};
  std::map<Instant, double> seen;
  for (int kill = 0; kill < kills; ++kill) {
    BackgroundProcess daemon{command, said};
    const int requests = server_.requests() + 1 + static_cast<int>(rng.below(8));
    ASSERT_TRUE(eventually([&] { return server_.requests() >= requests; }))
        << recald::testing::read_text(said);
    const auto before = committed();
    EXPECT_EQ(daemon.end(SIGKILL), -SIGKILL);
    const auto after = committed();
    EXPECT_TRUE(std::ranges::includes(after, before)) << "after kill " << kill;
    EXPECT_TRUE(std::ranges::includes(after, seen)) << "after kill " << kill;
    seen = after;
  }
  const auto store = stores::open_checked(folder_ / "site.db", {}, {}).value().store;
  EXPECT_EQ(store->check().value().damage, "");
  EXPECT_GE(seen.size(), static_cast<std::size_t>(kills));
  // The register rises with each read, so a sample that stood twice would be seen.
  std::set<double> values;
  for (const auto& [time, value_kWh] : seen) EXPECT_TRUE(values.insert(value_kWh).second);
  std::optional<Instant> last;
  const auto read = store->for_each_interval(
      0, {Instant::min(), Instant::max()}, [&](const StoredInterval& interval) {
        if (last) {
          EXPECT_EQ(interval.reading.start - *last, std::chrono::minutes{1});
        }
        last = interval.reading.start;
      });
  EXPECT_TRUE(read.has_value());
}

}  // namespace
}  // namespace recald::daemon::kill_command_test
