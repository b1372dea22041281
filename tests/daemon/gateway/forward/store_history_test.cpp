#include "daemon/gateway/forward/outbox/store_history.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "adapters/sqlite/sqlite_store.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using recald::testing::TemporaryFolder;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::seconds;

const Instant kBegin = std::chrono::sys_days{std::chrono::year{2026} / 2 / 3} + hours{21};

class StoreHistoryTest : public ::testing::Test {
 protected:
  void store(const std::string& meter, seconds interval, Instant from, int count) {
    const std::uint32_t number = store_.meter_number(meter, interval).value();
    StoreBatch batch;
    for (int i = 0; i < count; ++i) {
      batch.intervals.push_back({{number, from + i * interval, static_cast<double>(i)}});
    }
    ASSERT_TRUE(store_.commit(batch).has_value());
  }
  void close(const std::string& meter, int month) {
    metering::MonthlyFigure figure{};
    figure.month = std::chrono::year{2026} / month;
    figure.daily_average_kWh = month;
    const auto number = store_.find_meter(meter).value().value();
    ASSERT_TRUE(store_.put_month(number, figure, "2025b", kBegin).has_value());
  }
  std::vector<OutboxEntry> after(std::int64_t number, int limit) {
    return history_after(store_, meters_, number, limit).value();
  }

  TemporaryFolder folder_;
  sqlite::SqliteStore store_ = sqlite::SqliteStore::open(folder_ / "site.db").value();
  std::vector<MeterInStore> meters_{{"steam", hours{1}}, {"main", seconds{60}}, {"none", hours{1}}};
};

/// What an entry is, without its number.
std::string words(const OutboxEntry& entry) {
  if (const auto* const one = std::get_if<StoredInterval>(&entry.stored)) {
    return entry.meter + " " + metering::to_string(one->reading.start);
  }
  return entry.meter + " " + metering::to_string(std::get<StoredMonth>(entry.stored).figure.month);
}

TEST_F(StoreHistoryTest, HasEverythingOnceWhereverItGoesOn) {
  store("main", seconds{60}, kBegin, 200);  // over midnight
  store("main", seconds{60}, kBegin + days{40}, 3);
  store("steam", hours{1}, kBegin, 30);
  close("main", 1);
  close("main", 2);
  close("steam", 2);
  const auto all = after(0, 10'000);
  ASSERT_EQ(all.size(), 236u);
  EXPECT_EQ(words(all.front()), "main 2026-02-03T21:00:00Z");
  EXPECT_EQ(words(all[202]), "main 2026-03-15T21:02:00Z");
  EXPECT_EQ(words(all[203]), "main 2026-01");
  EXPECT_EQ(words(all.back()), "steam 2026-02");
  EXPECT_TRUE(std::ranges::is_sorted(all, std::less_equal{}, &OutboxEntry::number));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto rest = after(all[i].number, 7);
    ASSERT_EQ(rest.size(), std::min<std::size_t>(7, all.size() - i - 1)) << i;
    for (std::size_t k = 0; k < rest.size(); ++k) {
      ASSERT_EQ(rest[k].number, all[i + 1 + k].number);
      ASSERT_EQ(words(rest[k]), words(all[i + 1 + k]));
    }
  }
}

TEST_F(StoreHistoryTest, NumbersMeanTheSameWhateverIsStoredMeanwhile) {
  store("main", seconds{60}, kBegin, 10);
  const auto before = after(0, 10'000);
  store("main", seconds{60}, kBegin - days{3}, 5);
  store("steam", hours{1}, kBegin - days{300}, 5);
  const auto rest = after(before[3].number, 3);
  ASSERT_EQ(rest.size(), 3u);
  EXPECT_EQ(rest[0].number, before[4].number);
  EXPECT_EQ(words(rest[0]), words(before[4]));
}

}  // namespace
}  // namespace recald::daemon
