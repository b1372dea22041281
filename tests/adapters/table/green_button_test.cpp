#include "adapters/table/green_button.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace recald::table::green_button_test {
namespace {

using metering::Utility;

std::string link(const std::string& rel, const std::string& to) {
  return "<link rel=\"" + rel + "\" href=\"https://host/espi/" + to + "\"/>";
}

std::string entry(const std::string& links, const std::string& content) {
  return "<entry>" + links + "<content>" + content + "</content></entry>";
}

std::string block(const std::string& start, const std::string& value) {
  return "<IntervalBlock><IntervalReading><timePeriod><duration>3600</duration><start>" + start +
         "</start></timePeriod><value>" + value + "</value></IntervalReading></IntervalBlock>";
}

std::string reading_type(const std::string& id, const std::string& uom, const std::string& power,
                         const std::string& behaviour = "4") {
  return entry(link("self", "ReadingType/" + id),
               "<ReadingType><accumulationBehaviour>" + behaviour +
                   "</accumulationBehaviour><intervalLength>3600</intervalLength>"
                   "<powerOfTenMultiplier>" +
                   power + "</powerOfTenMultiplier><uom>" + uom + "</uom></ReadingType>");
}

std::string usage_point(const std::string& id, const std::string& kind) {
  return entry(link("self", "UsagePoint/" + id), "<UsagePoint><ServiceCategory><kind>" + kind +
                                                     "</kind></ServiceCategory></UsagePoint>");
}

std::string meter(const std::string& at, const std::string& type) {
  return entry(link("self", at) + link("related", "ReadingType/" + type), "<MeterReading/>");
}

Result<Feed> parse(const std::string& text) { return parse_green_button(csv::bytes_of(text)); }

TEST(GreenButton, MetersHaveTheirOwnUnitsAndUtilities) {
  const auto feed = parse(
      "<feed>" + usage_point("1", "0") + usage_point("2", "1") +
      meter("UsagePoint/1/MeterReading/1", "A") + meter("UsagePoint/2/MeterReading/1", "B") +
      entry(link("up", "UsagePoint/1/MeterReading/1/IntervalBlock"), block("1704067200", "1500")) +
      entry(link("self", "UsagePoint/2/MeterReading/1/IntervalBlock/9"),
            block("1704067200", "25")) +
      reading_type("A", "72", "0") + reading_type("B", "169", "-1") + "</feed>");
  ASSERT_TRUE(feed.has_value()) << feed.error().message;
  ASSERT_EQ(feed->meters.size(), 2u);
  EXPECT_EQ(feed->meters[0].name, "UsagePoint/1/MeterReading/1");
  EXPECT_EQ(feed->meters[0].unit, "Wh");
  EXPECT_EQ(feed->meters[0].utility, Utility::electricity);
  EXPECT_EQ(feed->meters[1].unit, "therm");
  EXPECT_EQ(feed->meters[1].utility, Utility::gas);
  EXPECT_EQ(feed->meters[1].interval, std::chrono::hours{1});
  ASSERT_EQ(feed->readings.size(), 2u);
  EXPECT_DOUBLE_EQ(feed->readings[0].value, 1500.0);
  EXPECT_DOUBLE_EQ(feed->readings[1].value, 2.5);
}

TEST(GreenButton, BulkQuantityIsARegisterAndReadingsComeInOrderOfTime) {
  const auto feed = parse(
      "<feed>" + reading_type("A", "72", "3", "1") + meter("UsagePoint/1/MeterReading/1", "A") +
      entry(link("up", "UsagePoint/1/MeterReading/1/IntervalBlock"), block("1704070800", "8")) +
      entry(link("up", "UsagePoint/1/MeterReading/1/IntervalBlock"), block("1704067200", "")) +
      "</feed>");
  ASSERT_TRUE(feed.has_value()) << feed.error().message;
  EXPECT_TRUE(feed->meters.at(0).is_register);
  ASSERT_EQ(feed->readings.size(), 2u);
  EXPECT_TRUE(std::isnan(feed->readings[0].value));  // none was given
  EXPECT_DOUBLE_EQ(feed->readings[1].value, 8000.0);
}

TEST(GreenButton, WhatIsWrongIsASentence) {
  const auto refused = [](const std::string& text) {
    const auto feed = parse(text);
    return feed ? std::string{"read"} : feed.error().message;
  };
  EXPECT_NE(refused("<html/>").find("no interval readings"), std::string::npos);
  EXPECT_NE(refused("").find("no interval readings"), std::string::npos);
  EXPECT_NE(refused("<feed>" + entry("", block("soon", "1"))).find("'soon'"), std::string::npos);
  EXPECT_NE(refused("<feed>" + entry("", block("1704067200", "many"))).find("'many'"),
            std::string::npos);
  EXPECT_NE(refused("<feed><entry><content>").find("ends within <entry>"), std::string::npos);
  EXPECT_NE(refused("<feed><entry><a></entry>").find("no XML"), std::string::npos);
}

}  // namespace
}  // namespace recald::table::green_button_test
