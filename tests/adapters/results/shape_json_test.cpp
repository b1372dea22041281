#include "adapters/shapes/shape_json.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "adapters/results/job_result_json.hpp"

namespace recald::shapes {

struct Inner {
  double kWh = kAbsent;
  std::string word;
};
struct Outer {
  std::string name;
  bool flag = false;
  double value = kAbsent;
  int unlisted = 0;
  std::optional<Inner> one;
  std::vector<Inner> many;
  std::map<std::string, double> shares;
  std::optional<std::string> subject;
};

}  // namespace recald::shapes

SHAPE(recald::shapes::Inner, kWh, word);
SHAPE(recald::shapes::Outer, name, flag, value, one, many, shares, subject);

namespace recald::shapes {
namespace {

Outer example() {
  return {.name = "a \"name\"",
          .flag = true,
          .value = 0.1,
          .unlisted = 7,
          .one = Inner{.kWh = -1e300, .word = "x"},
          .many = {{.kWh = 1.0, .word = ""}, {.kWh = kAbsent, .word = "absent"}},
          .shares = {{"file", 0.25}, {"sensor", 0.75}},
          .subject = "steam"};
}

TEST(ShapeJson, HasTheFieldsInTheirOrderAndNullForWhatIsUnknown) {
  EXPECT_EQ(json_of(example()).dump(),
            R"({"name":"a \"name\"","flag":true,"value":0.1,"one":{"kWh":-1e+300,"word":"x"},)"
            R"("many":[{"kWh":1.0,"word":""},{"kWh":null,"word":"absent"}],)"
            R"("shares":{"file":0.25,"sensor":0.75},"subject":"steam"})");
  Outer infinite;
  infinite.value = std::numeric_limits<double>::infinity();
  EXPECT_EQ(
      json_of(infinite).dump(),
      R"({"name":"","flag":false,"value":null,"one":null,"many":[],"shares":{},"subject":null})");
}

TEST(ShapeJson, ReadsBackWhatItWrote) {
  Outer back;
  read(json_of(example()), back);
  EXPECT_EQ(json_of(back), json_of(example()));
  EXPECT_EQ(back.unlisted, 0);
}

/// Each field in turn is missing, or of each other type.
TEST(ShapeJson, WhatIsMissingOrOfAnotherTypeIsAbsent) {
  const Json whole = json_of(example());
  const Json nothing = json_of(Outer{});
  for (const auto& [key, value] : whole.items()) {
    for (const Json& other : {Json(), Json(3), Json("text"), Json(true), Json::array({1, "a"}),
                              Json{{"kWh", "no number"}, {"file", "x"}}}) {
      Json wrong = whole;
      wrong[key] = other;
      Outer got;
      read(wrong, got);
      const Json written = json_of(got);
      for (const auto& [name, kept] : written.items()) {
        EXPECT_TRUE(name == key || kept == whole[name]) << name << ": " << key << " is " << other;
      }
      const bool is_of_its_type =
          other.type() == value.type() || (other.is_number() && value.is_number());
      if (!is_of_its_type && !other.is_object()) {
        EXPECT_EQ(written[key], nothing[key]) << key << " is " << other;
      }
    }
    Json without = whole;
    without.erase(key);
    Outer got;
    read(without, got);
    EXPECT_EQ(json_of(got)[key], nothing[key]) << key;
  }
}

TEST(ShapeJson, OfAListOnlyObjectsAreTaken) {
  std::vector<Inner> many;
  read(Json::parse(R"([{"kWh":2},3,null,"x",{"word":"y"}])"), many);
  ASSERT_EQ(many.size(), 2U);
  EXPECT_EQ(many[0].kWh, 2.0);
  EXPECT_TRUE(std::isnan(many[1].kWh));
}

TEST(ShapeJson, AnAlarmOfALaterReleaseHasAnUnknownCauseAndNoConsequence) {
  const auto read_alarms = [](const std::string& kind, const std::string& consequence) {
    return results::read_job_result(R"({"alarms":[{"output":"main_daily_kWh","causes":[{"kind":)" +
                                    kind + R"(,"probability":0.6}],"consequence":)" + consequence +
                                    "}]}")
        .drift->alarms.at(0);
  };
  const DriftAlarm known = read_alarms(R"("use")", R"("meter_set_aside")");
  EXPECT_EQ(known.causes.at(0).kind, drift::CauseKind::direction);
  EXPECT_EQ(known.consequence, drift::Consequence::meter_set_aside);
  for (const char* other : {R"("ghosts")", R"("")", "7", "null"}) {
    const DriftAlarm alarm = read_alarms(other, other);
    EXPECT_EQ(alarm.causes.at(0).kind, drift::CauseKind::unknown) << other;
    EXPECT_EQ(alarm.causes.at(0).probability, 0.6) << other;
    EXPECT_EQ(alarm.consequence, drift::Consequence::none) << other;
  }
}

}  // namespace
}  // namespace recald::shapes
