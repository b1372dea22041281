/// What the hours of a building say of a change, and that they say it of the record up to a month.
#include "daemon/site/drift/hours_since.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>

#include "daemon/commands/open_site.hpp"
#include "tests/daemon/on_simulated_building.hpp"
#include "tests/daemon/tampered_readings.hpp"

namespace recald::daemon {
namespace {

using recald::testing::read_text;
using recald::testing::write_text;
using testing::multiplied;

/// Three years, of which the chilled-water meter reads too much from the third June on.
class HoursSince : public testing::OnSimulatedBuilding {
 protected:
  static constexpr int kSince = 29;  // The third June, as a place among the months.
  static constexpr int kUntil = 33;

  void SetUp() override {
    OnSimulatedBuilding::SetUp();
    const std::string readings = read_text(folder_ / "readings.csv");
    const int first = std::stoi(readings.substr(readings.find('\n') + 1, 4));
    for (int month = 0; month < 36; ++month) {
      const std::string number = std::to_string(month % 12 + 1);
      months_.push_back(std::to_string(first + month / 12) + (month % 12 < 9 ? "-0" : "-") +
                        number);
    }
    readings_ = multiplied(readings, "chilled_water", months_[kSince] + "-01T04:00:00Z", 1.4);
  }

  [[nodiscard]] std::optional<drift::NamedChange> asked_of(const std::string& readings) {
    write_text(folder_ / "readings.csv", readings);
    std::ostringstream said;
    const auto site =
        open_modelled_site(folder_ / "site.toml", Console{said, said, false}, ModelKind::hourly);
    EXPECT_TRUE(site.has_value()) << said.str();
    const auto ask = ask_hours_of(*site, months_, {"electricity", "chilled_water", "steam"}, {});
    const drift::Alarm alarm{.month = kSince + 1,
                             .output = 1,
                             .direction = 1,
                             .evidence = 1e6,
                             .since = kSince,
                             .since_earliest = kSince,
                             .since_latest = kSince,
                             .is_calibrated = true};
    return ask(alarm, 0, kUntil, [] { return true; });
  }

  std::vector<std::string> months_;
  std::string readings_;
};

TEST_F(HoursSince, NameTheMeterThatReadsTooMuch) {
  const auto change = asked_of(readings_);
  ASSERT_TRUE(change.has_value());
  const auto& first =
      *std::ranges::max_element(change->effects, {}, &drift::NamedEffect::probability);
  EXPECT_EQ(first.effect, "scale_fault");
  EXPECT_EQ(first.output, 1);
  double sum = change->unknown;
  for (const drift::NamedEffect& effect : change->effects) sum += effect.probability;
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

TEST_F(HoursSince, ReadNothingOfLaterMonths) {
  const auto change = asked_of(readings_);
  const auto other =
      asked_of(multiplied(readings_, "chilled_water", months_[kUntil + 1] + "-01T06:00:00Z", 0.2));
  ASSERT_TRUE(change.has_value() && other.has_value());
  ASSERT_EQ(change->effects.size(), other->effects.size());
  for (std::size_t i = 0; i < change->effects.size(); ++i) {
    EXPECT_EQ(change->effects[i].probability, other->effects[i].probability)
        << change->effects[i].effect;
  }
}

}  // namespace
}  // namespace recald::daemon
