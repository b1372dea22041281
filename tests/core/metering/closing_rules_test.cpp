#include "core/metering/months/closing_rules.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>

namespace recald::metering {
namespace {

using std::chrono::seconds;

TEST(ClosingRules, AreTheSameTextForTheSameRulesAlways) {
  // The store of a running gateway has this text: another one closes all its months anew.
  EXPECT_EQ(closing_rules({}, {.id = "main"}), "f3ca8c66ebf184b0");
  EXPECT_EQ(closing_rules({}, {.id = "main"}), closing_rules({}, {.id = "heat"}));
}

TEST(ClosingRules, EachRuleMatters) {
  struct Rules {
    ClosingOptions closing;
    Meter meter;
  };
  const std::vector<std::function<void(Rules&)>> changes{
      [](Rules& r) { r.closing.coverage_min = 0.7; },
      [](Rules& r) { r.closing.gap_max = seconds{86'400}; },
      [](Rules& r) { r.closing.fill.rule = FillRule::linear_short; },
      [](Rules& r) { r.closing.fill.daytype = true; },
      [](Rules& r) { r.closing.fill.holidays = {std::chrono::year{2024} / std::chrono::May / 1}; },
      [](Rules& r) { r.closing.fill.holidays = {std::chrono::year{2024} / std::chrono::May / 2}; },
      [](Rules& r) { r.closing.validation.spike_rise = 2.0; },
      [](Rules& r) { r.closing.validation.spike_days_around = 3; },
      [](Rules& r) { r.closing.validation.stuck_intervals = 24; },
      [](Rules& r) { r.meter.rated_kW = 0.0; },
      [](Rules& r) { r.meter.rated_kW = 400.0; },
      [](Rules& r) { r.meter.zero_run_max = seconds{0}; },
      [](Rules& r) { r.meter.stuck_max = seconds{0}; },
      [](Rules& r) { r.meter.negative_is_valid = true; },
      [](Rules& r) { r.meter.is_counted = true; },
      [](Rules& r) { r.meter.peak.window = seconds{1800}; },
      [](Rules& r) { r.meter.utility = Utility::steam; }};
  std::set<std::string> seen{closing_rules({}, {})};
  for (const auto& change : changes) {
    Rules rules;
    change(rules);
    seen.insert(closing_rules(rules.closing, rules.meter));
  }
  EXPECT_EQ(seen.size(), changes.size() + 1);
}

}  // namespace
}  // namespace recald::metering
