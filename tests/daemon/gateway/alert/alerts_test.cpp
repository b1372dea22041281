/// Who is told what, and when, on a virtual clock with a scripted mail server.
#include "daemon/gateway/alert/alerts.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "adapters/sqlite/sqlite_store.hpp"
#include "tests/support/failing_store.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/virtual_loop.hpp"
#include "tests/support/virtual_worker.hpp"

namespace recald::daemon::alerts_test {
namespace {

using metering::Instant;
using recald::testing::FailingStore;
using recald::testing::TemporaryFolder;
using recald::testing::VirtualLoop;
using recald::testing::VirtualWorker;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

const Instant kNoon = std::chrono::sys_days{std::chrono::year{2026} / 2 / 3} + hours{12};

SiteConfig site_with(const std::string& alerts) {
  const auto site = parse_site(R"(
[site]
id = "depot"
name = "The depot"
timezone = "Europe/Berlin"
[[meter]]
id = "main"
source = "http"
utility = "electricity"
[alerts]
)" + alerts,
                               "/nowhere/site.toml");
  if (!site) throw std::runtime_error(site.error().front());
  return *site;
}

constexpr const char* kMail =
    "[[alerts.mail]]\nserver = \"smtp://localhost\"\nfrom = \"recald@example.org\"\n"
    "to = \"ada@example.org\"\n";
constexpr const char* kHook = "[[alerts.webhook]]\nurl = \"http://localhost/hook\"\n";

class AlertsTest : public ::testing::Test {
 protected:
  void begin(const std::string& alerts) { begin(site_with(alerts)); }
  void begin(const SiteConfig& site, Alerts::Notified told = {}) {
    alerts_ = std::make_unique<Alerts>(
        Alerts::Ports{loop_, failing_, make_worker_}, std::make_shared<const SiteConfig>(site),
        metering::LocalCalendar::open("Europe/Berlin").value(),
        [this](const AlertDestination& to, const AlertMessage& message, const std::stop_token&) {
          return take(to, message);
        },
        [this](StoreEvent event) { note(std::move(event)); }, std::move(told));
  }

  Result<void> take(const AlertDestination& to, const AlertMessage& message) {
    ++tries_;
    const bool is_mail = std::holds_alternative<MailConfig>(to);
    if (is_mail && mail_fails_) return failure(ErrorCode::io_failed, "connection refused");
    const bool is_refused =
        is_mail && !refused_.empty() && message.text.find(refused_) != std::string::npos;
    if (is_refused) return failure(ErrorCode::out_of_range, "552 too long");
    auto& box = is_mail ? mails_ : hooks_;
    box.push_back(message);
    return {};
  }

  /// As the gateway does: it says what happens, and commits it as soon as the store accepts.
  void note(StoreEvent event) {
    if (event.time == Instant{}) event.time = loop_.now().instant();
    waiting_.push_back(event);
    if (!failing_.refuses) {
      ASSERT_TRUE(store_.commit({.events = std::exchange(waiting_, {})}).has_value());
    }
    alerts_->observe(event);
  }
  void happens(const std::string& kind, Severity severity = Severity::warning,
               const std::string& subject = "main") {
    note({.time = {}, .severity = severity, .kind = kind, .subject = subject, .text = "it is so"});
  }
  static std::vector<std::string> subjects(const std::vector<AlertMessage>& box) {
    std::vector<std::string> found;
    for (const AlertMessage& one : box) found.push_back(one.subject);
    return found;
  }

  TemporaryFolder folder_;
  sqlite::SqliteStore store_ = sqlite::SqliteStore::open(folder_ / "site.db").value();
  FailingStore failing_{store_};
  VirtualLoop loop_{kNoon};
  std::function<std::unique_ptr<Worker>()> make_worker_ = [this] {
    return std::make_unique<VirtualWorker>(loop_, seconds{2});
  };
  std::unique_ptr<Alerts> alerts_;
  std::vector<StoreEvent> waiting_;
  std::vector<AlertMessage> mails_;
  std::vector<AlertMessage> hooks_;
  bool mail_fails_ = false;
  std::string refused_;  ///< What a mail must not contain.
  int tries_ = 0;
};

TEST_F(AlertsTest, EachIsToldOnce) {
  begin(std::string{kMail} + kHook);
  happens("meter_silent");
  happens("counter_bounce", Severity::info);  // nobody chose it
  loop_.run_for(hours{30});
  EXPECT_THAT(subjects(mails_), ElementsAre("The depot: a meter is silent (main)"));
  EXPECT_THAT(subjects(hooks_), SizeIs(1));
  begin(std::string{kMail} + kHook);  // another process
  loop_.run_for(hours{1});
  EXPECT_THAT(mails_, SizeIs(1));
  EXPECT_THAT(hooks_, SizeIs(1));
}

TEST_F(AlertsTest, WhatHappensTogetherIsOneMessage) {
  begin("pages = \"https://gw.example.org:8080/\"\n" + std::string{kMail} + kHook);
  happens("meter_silent");
  loop_.run_for(seconds{3});
  happens("drift_alarm", Severity::warning, "");
  loop_.run_for(minutes{2});
  ASSERT_THAT(subjects(mails_), ElementsAre("The depot: 2 alerts"));
  EXPECT_THAT(mails_[0].text, HasSubstr("A meter is silent\n2026-02-03 13:00\nIt is so\n"
                                        "https://gw.example.org:8080/meters/main\n"));
  EXPECT_THAT(mails_[0].text, HasSubstr("https://gw.example.org:8080/model\n"));
  const auto json = nlohmann::json::parse(hooks_.at(0).document);
  EXPECT_EQ(json["site"], "depot");
  EXPECT_EQ(json["text"], "The depot: 2 alerts");
  ASSERT_EQ(json["alerts"].size(), 2);
  EXPECT_EQ(json["alerts"][0]["kind"], "meter_silent");
  EXPECT_EQ(json["alerts"][0]["severity"], "warning");
  EXPECT_EQ(json["alerts"][0]["time"], "2026-02-03T12:00:00Z");
  EXPECT_EQ(json["alerts"][0]["page"], "https://gw.example.org:8080/meters/main");
}

TEST_F(AlertsTest, AServerThatIsDownIsTriedAgainAndHoldsUpNobody) {
  begin(std::string{kMail} + kHook);
  mail_fails_ = true;
  happens("meter_silent");
  loop_.run_for(minutes{1});
  EXPECT_THAT(hooks_, SizeIs(1));
  loop_.run_for(hours{5});
  EXPECT_THAT(mails_, IsEmpty());
  EXPECT_GT(tries_, 8);  // after 1, 2, 4, 8, 16, 32 minutes, then every hour
  EXPECT_LT(tries_, 14);
  int said = 0;
  const auto events = store_.events(100).value();
  for (const StoreEvent& event : events) {
    if (event.kind != "alert_not_sent") continue;
    ++said;
    EXPECT_EQ(event.subject, "mail to ada@example.org");
    EXPECT_THAT(event.text, HasSubstr("connection refused; recald keeps trying"));
  }
  EXPECT_EQ(said, 1);
  mail_fails_ = false;
  loop_.run_for(hours{1});
  EXPECT_THAT(mails_, SizeIs(1));
  EXPECT_THAT(hooks_, SizeIs(1));
}

TEST_F(AlertsTest, AServerThatHangsHoldsUpNobodyElse) {
  seconds length = minutes{10};  // of the webhook's, whose worker is made first
  make_worker_ = [this, &length] {
    return std::make_unique<VirtualWorker>(loop_, std::exchange(length, seconds{2}));
  };
  begin(std::string{kMail} + kHook);
  happens("meter_silent");
  loop_.run_for(minutes{1});
  EXPECT_THAT(hooks_, IsEmpty());
  EXPECT_THAT(mails_, SizeIs(1));
}

// An alert that a server will never take must not hold up those behind it.
TEST_F(AlertsTest, WhatAServerRefusesIsSetAsideAndTheOthersArrive) {
  begin(kMail);
  refused_ = "Bad";
  for (int i = 0; i < 9; ++i) {
    note({.time = {},
          .severity = Severity::warning,
          .kind = "meter_silent",
          .subject = fmt::format("m{}", i),
          .text = fmt::format("{} {}", i == 2 || i == 5 ? "bad" : "good", i)});
  }
  loop_.run_for(minutes{3});
  std::string sent;
  for (const AlertMessage& mail : mails_) sent += mail.text;
  for (const int i : {0, 1, 3, 4, 6, 7, 8}) {
    EXPECT_THAT(sent, HasSubstr(fmt::format("Good {}", i)));
  }
  std::vector<std::string> said;
  const auto events = store_.events(100).value();
  for (const StoreEvent& event : events) {
    if (event.kind == "alert_refused" || event.kind == "alert_not_sent") said.push_back(event.text);
  }
  ASSERT_THAT(said, SizeIs(1));  // of one day: counted, with the last sentence
  EXPECT_THAT(said[0], HasSubstr("mail to ada@example.org refuses an alert and takes others; it is "
                                 "not sent again: bad 5"));
  const int tries = tries_;
  begin(kMail);  // another process
  loop_.run_for(hours{1});
  EXPECT_EQ(tries_, tries);
}

// It is the server, not the alerts: nothing is lost while it refuses everything.
TEST_F(AlertsTest, AServerThatRefusesEverythingGetsItLater) {
  begin(kMail);
  refused_ = "Times are in";
  for (int i = 0; i < 3; ++i) {
    happens("meter_silent", Severity::warning, fmt::format("m{}", i));
  }
  loop_.run_for(hours{5});
  EXPECT_THAT(mails_, IsEmpty());
  EXPECT_LT(tries_, 14 * 6);
  refused_.clear();
  loop_.run_for(hours{2});
  std::string sent;
  for (const AlertMessage& mail : mails_) sent += mail.document;
  for (const char* meter : {"m0", "m1", "m2"}) EXPECT_THAT(sent, HasSubstr(meter));
  int refusals = 0;
  const auto events = store_.events(100).value();
  for (const StoreEvent& event : events) {
    refusals += event.kind == "alert_refused" ? 1 : 0;
  }
  EXPECT_EQ(refusals, 0);
}

// The mail of an event that is three days old helps nobody.
TEST_F(AlertsTest, AServerThatIsDownForAWeekGetsNoFlood) {
  begin(kMail);
  mail_fails_ = true;
  happens("meter_silent");
  loop_.run_for(hours{7 * 24});
  mail_fails_ = false;
  happens("meter_answers", Severity::info);
  loop_.run_for(hours{2});
  EXPECT_THAT(subjects(mails_), ElementsAre("The depot: a meter answers again (main)"));
}

TEST_F(AlertsTest, AtNightOnlyErrorsAreSent) {
  begin("quiet = \"22:00-07:00\"\n" + std::string{kMail});
  loop_.run_for(hours{10});  // 23:00 in Berlin
  happens("meter_silent");
  loop_.run_for(hours{4});
  EXPECT_THAT(mails_, IsEmpty());
  happens("store_damaged", Severity::error, "");
  loop_.run_for(minutes{1});
  EXPECT_THAT(subjects(mails_), ElementsAre("The depot: 2 alerts"));
  happens("meter_answers", Severity::info);
  loop_.run_for(hours{4} - minutes{5});
  EXPECT_THAT(mails_, SizeIs(1));
  loop_.run_for(minutes{6});  // 07:01
  EXPECT_THAT(mails_, SizeIs(2));
}

// A bus that drops and returns makes as many events as it has meters, and more.
TEST_F(AlertsTest, AtNightAnErrorIsFoundBehindAThousandOthers) {
  begin("quiet = \"22:00-07:00\"\n" + std::string{kMail});
  loop_.run_for(hours{10});
  for (int i = 0; i < 1200; ++i) happens("meter_silent", Severity::warning, fmt::format("m{}", i));
  loop_.run_for(minutes{5});
  EXPECT_THAT(mails_, IsEmpty());
  happens("store_damaged", Severity::error, "");
  loop_.run_for(minutes{5});
  EXPECT_THAT(subjects(mails_), ElementsAre("The depot: 500 alerts", "The depot: 500 alerts",
                                            "The depot: 201 alerts"));
}

// Its mail server refuses the password from the first day on, and somebody mends it two days later.
TEST_F(AlertsTest, WhatADestinationNeverGotIsNotForgottenByARestart) {
  mail_fails_ = true;
  begin(kMail);
  happens("meter_silent");
  loop_.run_for(hours{48});
  mail_fails_ = false;
  begin(kMail);
  loop_.run_for(minutes{5});
  EXPECT_THAT(mails_, SizeIs(1));
}

TEST_F(AlertsTest, WhatHappenedBeforeTheClockWasSetIsTold) {
  begin(kMail);
  note({.time = Instant{seconds{60}},
        .severity = Severity::error,
        .kind = "no_store",
        .subject = "",
        .text = "it is so"});
  loop_.run_for(minutes{5});
  EXPECT_THAT(mails_, SizeIs(1));
}

// A full disk takes no events either.
TEST_F(AlertsTest, AStoreThatRefusesIsToldFromMemoryAndOnce) {
  begin(kMail);
  loop_.run_for(minutes{1});
  failing_.refuses = true;
  happens("meter_silent");
  happens("store_refuses", Severity::error, "");
  loop_.run_for(hours{2});
  EXPECT_THAT(subjects(mails_), ElementsAre("The depot: 2 alerts"));
  failing_.refuses = false;
  happens("store_accepts", Severity::info, "");  // committed with what waited
  loop_.run_for(hours{2});
  EXPECT_THAT(subjects(mails_),
              ElementsAre("The depot: 2 alerts", "The depot: readings are stored again"));
  begin(kMail);
  loop_.run_for(hours{2});
  EXPECT_THAT(mails_, SizeIs(2));
}

// A destination that came later, or a kind that was chosen later, has not been told of it.
TEST_F(AlertsTest, WhatHappenedLongBeforeADiskFillsIsNoNews) {
  begin(kMail);
  happens("meter_silent");
  loop_.run_for(hours{2});
  alerts_->set_site(std::make_shared<const SiteConfig>(site_with(std::string{kMail} + kHook)));
  loop_.run_for(minutes{5});
  failing_.refuses = true;
  happens("store_refuses", Severity::error, "");
  loop_.run_for(minutes{5});
  ASSERT_THAT(hooks_, SizeIs(1));
  EXPECT_THAT(hooks_[0].text, Not(HasSubstr("silent")));
}

// More than one message holds, and the store has none of it.
TEST_F(AlertsTest, AThousandEventsOfAFullDiskAreToldOnce) {
  begin(kMail);
  happens("meter_silent", Severity::warning, "first");
  loop_.run_for(minutes{1});
  failing_.refuses = true;
  happens("store_refuses", Severity::error, "");
  for (int i = 0; i < 700; ++i) happens("meter_silent", Severity::warning, fmt::format("m{}", i));
  loop_.run_for(minutes{5});
  EXPECT_THAT(subjects(mails_), ElementsAre("The depot: a meter is silent (first)",
                                            "The depot: 500 alerts", "The depot: 201 alerts"));
  failing_.refuses = false;
  happens("store_accepts", Severity::info, "");
  loop_.run_for(minutes{5});
  begin(kMail);
  loop_.run_for(minutes{5});
  EXPECT_THAT(mails_, SizeIs(4));
}

TEST_F(AlertsTest, WhatWasKeptInMemoryIsNotToldAgainFromTheStore) {
  begin(kMail);
  happens("meter_silent");
  loop_.run_for(minutes{1});
  ASSERT_THAT(mails_, SizeIs(1));
  // The same event, taken over into another store.
  const TemporaryFolder other;
  auto found = sqlite::SqliteStore::open(other / "site.db").value();
  ASSERT_TRUE(found.commit({.events = store_.events_after(0, 100).value()}).has_value());
  auto told = alerts_->take_notified();
  alerts_ = std::make_unique<Alerts>(
      Alerts::Ports{loop_, found, make_worker_},
      std::make_shared<const SiteConfig>(site_with(kMail)),
      metering::LocalCalendar::open("Europe/Berlin").value(),
      [this](const AlertDestination& to, const AlertMessage& message, const std::stop_token&) {
        return take(to, message);
      },
      [](const StoreEvent&) {}, std::move(told));
  loop_.run_for(hours{1});
  EXPECT_THAT(mails_, SizeIs(1));
}

// Whoever is added tomorrow is not told of last year.
TEST_F(AlertsTest, ANewDestinationIsToldOfTheLastHour) {
  begin(kMail);
  happens("meter_silent");
  loop_.run_for(hours{2});
  happens("meter_answers", Severity::info);
  loop_.run_for(minutes{5});
  ASSERT_THAT(mails_, SizeIs(2));
  alerts_->set_site(std::make_shared<const SiteConfig>(site_with(std::string{kMail} + kHook)));
  loop_.run_for(minutes{5});
  EXPECT_THAT(mails_, SizeIs(2));
  EXPECT_THAT(subjects(hooks_), ElementsAre("The depot: a meter answers again (main)"));
}

TEST_F(AlertsTest, OnlyWhatWasChosen) {
  begin("about = \"counter_reset\"\n" + std::string{kMail});
  happens("meter_silent");
  happens("counter_reset");
  loop_.run_for(minutes{5});
  EXPECT_THAT(subjects(mails_), ElementsAre("The depot: a counter was reset (main)"));
}

TEST(AlertNames, HoldNoSecret) {
  const WebhookConfig hook{.url = "https://hooks.example.org/services/secret"};
  EXPECT_THAT(destination_of(hook).id, Not(HasSubstr("secret")));
  EXPECT_THAT(destination_of(hook).words, Not(HasSubstr("secret")));
  EXPECT_NE(destination_of(hook).id,
            destination_of(WebhookConfig{.url = "https://hooks.example.org/other"}).id);
}

}  // namespace
}  // namespace recald::daemon::alerts_test
