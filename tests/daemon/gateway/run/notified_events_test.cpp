/// Events that somebody is told of: a store that refuses, meters that fall silent.
#include <gmock/gmock.h>

#include "daemon/gateway/run/gateway.hpp"
#include "tests/daemon/gateway/gateway_rig.hpp"

namespace recald::daemon::notified_events_test {
namespace {

using metering::Instant;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using ::testing::ElementsAre;
using ::testing::StartsWith;

const Instant kStart = testing::kRigStart;

class ToldEvents : public ::testing::Test, protected testing::RigInMemory {
 protected:
  ToldEvents() : RigInMemory{kStart} {}
  /// "meter_silent main +90", in minutes since the start, oldest first.
  std::vector<std::string> told() {
    std::vector<std::string> words;
    const auto events = disk_.events_after(0, 1000).value();
    for (const StoreEvent& event : events) {
      const auto at = std::chrono::duration_cast<minutes>(event.time - kStart).count();
      words.push_back(fmt::format("{}{}{} +{}", event.kind, event.subject.empty() ? "" : " ",
                                  event.subject, at));
    }
    return words;
  }
  void be_silent(milliseconds from, milliseconds to) {
    devices_[2].is_silent = [=](milliseconds t) { return t > from && t < to; };
  }
  SiteConfig site_ = load(testing::two_meter_site());
};

TEST_F(ToldEvents, AMeterThatFallsSilentTwiceIsToldTwice) {
  devices_[2].is_silent = [](milliseconds t) {
    return (t > hours{2} + minutes{1} && t < hours{4}) || (t > hours{7} && t < hours{9});
  };
  begin(site_);
  loop_.run_for(hours{10});
  EXPECT_THAT(
      told(),
      ElementsAre("meter_silent cooling +151", StartsWith("meter_answers cooling +24"),
                  StartsWith("meter_silent cooling +4"), StartsWith("meter_answers cooling +54")));
}

// Another process is no answer and no new silence.
TEST_F(ToldEvents, ASilenceIsNotToldAgainByTheNextProcess) {
  be_silent(hours{1}, hours{9});
  begin(site_);
  loop_.run_for(hours{2});
  begin(site_);
  loop_.run_for(hours{2});
  EXPECT_EQ(told().size(), 1U);
  loop_.run_for(hours{6});
  EXPECT_EQ(told().size(), 2U);
}

// The operator's last word must not be that all is well.
TEST_F(ToldEvents, AStoreThatRefusesAgainIsToldWithinTheHour) {
  begin(site_);
  loop_.run_for(minutes{10});
  store_.refuses = true;
  loop_.run_for(minutes{10});
  store_.refuses = false;
  loop_.run_for(minutes{1});
  store_.refuses = true;
  loop_.run_for(hours{4});
  store_.refuses = false;
  loop_.run_for(minutes{1});
  const auto words = told();
  ASSERT_EQ(words.size(), 4U);
  EXPECT_THAT(words[0], StartsWith("store_refuses +1"));
  EXPECT_THAT(words[1], StartsWith("store_accepts +2"));
  EXPECT_THAT(words[2], StartsWith("store_refuses +7"));
  EXPECT_THAT(words[3], StartsWith("store_accepts +26"));
}

// A site of pushed meters alone commits nothing by itself.
TEST_F(ToldEvents, ADiskThatIsFullForPushedReadingsIsTold) {
  begin(load(testing::site_head("America/Chicago") +
             "[[meter]]\nid = \"chw\"\nsource = \"http\"\nutility = \"chilled_water\"\n"));
  const auto push = [&](int quarter) {
    return gateway_->take_pushed("chw", {{0, kStart + quarter * minutes{15}, 5.0}}).has_value();
  };
  EXPECT_TRUE(push(0));
  store_.refuses = true;
  EXPECT_FALSE(push(1));
  store_.refuses = false;
  EXPECT_TRUE(push(1));
  loop_.run_for(minutes{1});
  EXPECT_THAT(told(), ElementsAre("store_refuses +0", "store_accepts +0"));
}

// Who sends yesterday's file every day sends nothing.
TEST_F(ToldEvents, ReadingsThatAreKnownAreNoSignOfLife) {
  begin(load(testing::site_head("America/Chicago") +
             "[[meter]]\nid = \"chw\"\nsource = \"http\"\nutility = \"chilled_water\"\n"));
  for (int day = 0; day < 3; ++day) {
    ASSERT_TRUE(gateway_->take_pushed("chw", {{0, kStart, 5.0}}).has_value());
    loop_.run_for(hours{24});
  }
  EXPECT_THAT(told(), ElementsAre(StartsWith("meter_silent chw +216")));
}

}  // namespace
}  // namespace recald::daemon::notified_events_test
