/// Registers that are no counters, on a gateway with a real store: what holds of their intervals,
/// and what is told. Each case is drawn.
#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <random>

#include "tests/daemon/gateway/gateway_rig.hpp"

namespace recald::daemon::doubtful_counters_test {
namespace {

using metering::Instant;
using metering::Validity;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::HasSubstr;

const Instant kStart = testing::kRigStart;

/// The words of a value as a device sends them.
modbus::Words words_of(std::uint64_t bits, int count, std::string_view order) {
  modbus::Words words;
  for (int i = count - 1; i >= 0; --i) {
    auto word = static_cast<std::uint16_t>(bits >> (16 * i));
    if (order == "BADC" || order == "DCBA") word = std::rotl(word, 8);
    words.push_back(word);
  }
  if (order == "CDAB" || order == "DCBA") std::ranges::reverse(words);
  return words;
}

class DoubtfulCounters : public ::testing::TestWithParam<int>, protected testing::RigInMemory {
 protected:
  DoubtfulCounters() : RigInMemory{kStart} {}

  int draw(int last) { return std::uniform_int_distribution{0, last}(random_); }
  template <class T>
  T one_of(std::initializer_list<T> choices) {
    return std::data(choices)[draw(static_cast<int>(choices.size()) - 1)];
  }

  /// One meter with one register. @param raw  What stands in it.
  void begin(const std::string& type, double scale,
             std::function<std::uint64_t(milliseconds)> raw) {
    const std::string order{one_of({"ABCD", "CDAB", "BADC", "DCBA"})};
    const int count = type.ends_with("64") ? 4 : type.ends_with("32") ? 2 : 1;
    recald::testing::write_text(
        folder_.path() / "counter.toml",
        fmt::format("source = \"the test\"\nbase = 0\nenergy = [\"energy\"]\nregister.energy = {{ "
                    "at = 0, type = \"{}\", order = \"{}\", scale = {}, unit = \"kWh\" }}\n",
                    type, order, scale));
    std::string meter = testing::kMainMeter;
    const std::string poll{one_of({"10s", "60s", "5m"})};
    meter.replace(meter.find("60s"), 3, poll);
    SCOPED_TRACE(fmt::format("{} {} {} {}", type, order, scale, poll));
    devices_[1].registers = [=](milliseconds t) { return words_of(raw(t), count, order); };
    site_ = load(testing::site_head("America/Chicago") + meter);
    begin_again();
  }
  void begin_again() { RigInMemory::begin(*site_); }

  std::vector<StoreEvent> told(std::string_view kind) {
    auto all = disk_.events(1'000).value();
    std::erase_if(all, [&](const StoreEvent& event) { return event.kind != kind; });
    return all;
  }
  int count(Validity validity, milliseconds from = milliseconds{0}) {
    const auto readings =
        stored("main", {kStart + std::chrono::floor<seconds>(from), metering::kLatestInstant});
    return static_cast<int>(std::ranges::count(readings, validity, &metering::Reading::validity));
  }

  std::mt19937 random_{static_cast<unsigned>(GetParam())};
  std::optional<SiteConfig> site_;
};

INSTANTIATE_TEST_SUITE_P(Drawn, DoubtfulCounters, ::testing::Range(0, 16),
                         [](const auto& made) { return "seed_" + std::to_string(made.param); });

// A gateway that ends and begins again tells nothing twice and believes nothing in between.
TEST_P(DoubtfulCounters, ARegisterThatStartsAgainAtEachReadIsToldAndNotBelieved) {
  // What a load can have counted since the last read, at any of the polls.
  const bool is_ordered = draw(1) == 1;
  const double scale = one_of({0.01, 0.1, 1.0});
  const int most = is_ordered || scale > 0.1 ? one_of({2, 3}) : one_of({2, 3, 9});
  std::uint64_t reads = 0;
  const auto next = [&, this](milliseconds) -> std::uint64_t {
    return is_ordered ? reads++ % static_cast<std::uint64_t>(most + 1)
                      : static_cast<std::uint64_t>(draw(most));
  };
  begin(one_of<std::string>({"u16", "i32", "u32", "u64"}), scale, next);
  loop_.run_for(hours{20});
  begin_again();
  loop_.run_for(hours{10});
  const auto events = told("counter_no_total");
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].severity, Severity::warning);
  EXPECT_EQ(events[0].subject, "main");
  EXPECT_THAT(events[0].text, HasSubstr("so it is no total"));
  EXPECT_EQ(count(Validity::ok, hours{2}), 0);
  EXPECT_GT(count(Validity::suspect), 2);
  EXPECT_GT(count(Validity::missing), 80);
}

struct NoValue {
  std::string type;
  std::uint64_t bits;
  std::string words;  ///< As an event says them.
};

// From the first read on, or suddenly: it is told with what to write, and no interval is 0 kWh.
TEST_P(DoubtfulCounters, AUsualNoValueIsToldWithWhatToWrite) {
  const auto none = one_of<NoValue>({{"u16", 0xFFFF, "0xFFFF"},
                                     {"u16", 0x7FFF, "0x7FFF"},
                                     {"i16", 0x8000, "0x8000"},
                                     {"i16", 0x7FFF, "0x7FFF"},
                                     {"u32", 0xFFFFFFFF, "0xFFFFFFFF"},
                                     {"u32", 0x80000000, "0x80000000"},
                                     {"i32", 0x7FFFFFFF, "0x7FFFFFFF"},
                                     {"i32", 0xFFFFFFFF, "0xFFFFFFFF"},
                                     {"u64", 0xFFFFFFFFFFFFFFFF, "0xFFFFFFFFFFFFFFFF"},
                                     {"i64", 0x8000000000000000, "0x8000000000000000"},
                                     {"f32", 0x7F7FFFFF, "0x7F7FFFFF"}});
  const double scale = one_of({0.1, 1.0});
  const auto since = one_of<milliseconds>({milliseconds{0}, hours{5} + minutes{7}});
  begin(none.type, scale, [=](milliseconds t) -> std::uint64_t {
    if (t >= since) return none.bits;
    const double raw = 100.0 + 30.0 * testing::hours_of(t) / scale;
    if (none.type == "f32") return std::bit_cast<std::uint32_t>(static_cast<float>(raw));
    return static_cast<std::uint64_t>(raw);
  });
  loop_.run_for(hours{12});
  const auto events = told("counter_absent");
  ASSERT_EQ(events.size(), 1u);
  EXPECT_THAT(events[0].text, HasSubstr("absent = \"" + none.words + "\""));
  EXPECT_THAT(events[0].text, HasSubstr("[register.energy]"));
  EXPECT_EQ(count(Validity::ok, since), 0);
  EXPECT_EQ(count(Validity::ok), since > hours{1} ? 20 : 0);
}

// It passes the number on its way up, or stops there for a day, with a restart meanwhile.
TEST_P(DoubtfulCounters, ACounterThatReachesTheNumberIsKept) {
  const bool is_wide = draw(1) == 1;
  const std::uint64_t mark = (is_wide ? 0x7FFFFFFFu : 0x7FFFu) + static_cast<unsigned>(draw(1));
  const double scale = one_of({0.1, 1.0});
  const bool stops = draw(1) == 1;
  const double load_kW = one_of({2.0, 20.0, 200.0});
  const auto counted_kWh = [=](milliseconds t) {
    const double until_mark_kWh = 3.5 * load_kW;
    const double kWh = load_kW * testing::hours_of(t);
    return stops ? std::min(kWh, std::ceil(until_mark_kWh / scale) * scale) : kWh;
  };
  const auto steps_to_mark = static_cast<std::uint64_t>(std::ceil(3.5 * load_kW / scale));
  begin(is_wide ? "u32" : "u16", scale, [=](milliseconds t) {
    return mark - steps_to_mark +
           static_cast<std::uint64_t>(std::floor(counted_kWh(t) / scale + 1e-6));
  });
  loop_.run_for(hours{9});
  begin_again();
  loop_.run_for(hours{15});
  EXPECT_TRUE(told("counter_absent").empty());
  EXPECT_TRUE(told("counter_no_total").empty());
  EXPECT_EQ(count(Validity::missing), 0);
  EXPECT_EQ(count(Validity::ok), 24 * 4 - 1);
  EXPECT_NEAR(stored_kWh("main", {kStart, metering::kLatestInstant}),
              counted_kWh(hours{23} + minutes{45}), 2.0 * scale);
}

}  // namespace
}  // namespace recald::daemon::doubtful_counters_test
