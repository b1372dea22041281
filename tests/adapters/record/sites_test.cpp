#include "adapters/record/sites.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "tests/adapters/record/record_fixture.hpp"

namespace recald::record {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST_F(Record, TablesAreMadeOnceByWhoeverComesFirst) {
  const std::string name = server_->new_database();
  std::vector<std::jthread> makers;
  for (int i = 0; i < 4; ++i) {
    makers.emplace_back([&name] {
      auto own = postgres::Connection::open(name, "");
      ASSERT_TRUE(own) << own.error().message;
      const auto made = make_schema(**own);
      EXPECT_TRUE(made) << made.error().message;
    });
  }
  makers.clear();
  auto own = postgres::Connection::open(name, "");
  EXPECT_TRUE(check_schema(**own));
}

TEST_F(Record, AnotherSchemaIsNotTouched) {
  auto empty = postgres::Connection::open(server_->new_database(), "");
  const auto none = check_schema(**empty);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::unsupported);
  EXPECT_THAT(none.error().message, HasSubstr("recald fleet init"));
  EXPECT_TRUE(check_schema(*connection_));
  (void)ask("UPDATE fleet SET schema_version = 99");
  EXPECT_EQ(check_schema(*connection_).error().code, ErrorCode::unsupported);
  const auto made = make_schema(*connection_);
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().message, HasSubstr("schema 99"));
}

TEST_F(Record, WithoutTheRightToMakeRolesTheRestIsThere) {
  const std::string name = server_->new_database();
  const std::string database = name.substr(name.rfind('/') + 1);
  (void)server_->ask("DROP OWNED BY recald_ingest, recald_worker, recald_read", database);
  (void)server_->ask("CREATE USER owner; ALTER DATABASE " + database + " OWNER TO owner");
  for (const char* role : {"recald_ingest", "recald_worker", "recald_read"}) {
    (void)server_->ask(std::string{"ALTER ROLE "} + role + " RENAME TO kept_" + role);
  }
  auto owner = postgres::Connection::open(
      "postgresql://owner@127.0.0.1:" + std::to_string(server_->port()) + "/" + database, "");
  ASSERT_TRUE(owner) << owner.error().message;
  const auto made = make_schema(**owner);
  for (const char* role : {"recald_ingest", "recald_worker", "recald_read"}) {
    (void)server_->ask(std::string{"ALTER ROLE kept_"} + role + " RENAME TO " + role);
  }
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_THAT(*made, HasSubstr("the role recald_ingest has no rights here"));
  EXPECT_TRUE(check_schema(**owner));
}

TEST_F(Record, AnIngesterNeedsNoMoreThanItsRole) {
  const auto own = open_as("recald_ingest", "plain_ingester");
  auto batch = intervals(0, 3);
  batch.entries.push_back(month_entry(4, "steam", month_of(2024, 3), 1.0));
  batch.entries.push_back(month_entry(5, "power", month_of(2024, 3), 1.0));
  batch.events.push_back({.time = kNow, .kind = "reset", .text = "was reset", .number = 1});
  batch.results.push_back({.number = 1, .asked = kNow});
  const auto taken = take(*own, "tower", batch, kNow);
  EXPECT_TRUE(taken) << taken.error().message;
  EXPECT_EQ(ask("SELECT count(*) FROM job"), "1\n");
  EXPECT_FALSE(own->run("DELETE FROM interval"));
  for (const char* too_much :
       {"UPDATE interval SET mean_kw = 1", "UPDATE site SET id = 'mine'",
        "UPDATE site SET version = 7", "UPDATE site SET retired = now()", "SELECT * FROM site_file",
        "SELECT * FROM file", "SELECT * FROM whole_file", "SELECT * FROM site_state",
        "SELECT * FROM audit", "DELETE FROM event", "UPDATE job SET state = 'done'",
        "TRUNCATE interval",
        "INSERT INTO result (site, job, kind, month, at, accepted, named, message, summary, "
        "sha256) "
        "SELECT site, number, kind, month, now(), true, true, '', '', '' FROM job",
        "INSERT INTO audit (time, who, action, subject, text) VALUES (now(), 'a', 'b', 'c', 'd')",
        "INSERT INTO site (id, version, added) VALUES ('more', 1, now())"}) {
    EXPECT_FALSE(own->run(too_much)) << too_much;
  }
  leave("plain_ingester");
}

// Everything that a login could try in order to stand in the audit as another, or at another time.
TEST_F(Record, NobodyWritesTheAuditAsSomebodyElse) {
  const auto own = open_as("recald_worker", "plain_worker");
  const std::string rest = "action, subject, text) VALUES ('ann', ";
  for (const auto& forged : std::vector<std::string>{
           "INSERT INTO audit (who, role, " + rest + "'recald', 'b', 'c', 'd')",
           "INSERT INTO audit (who, time, " + rest + "'2001-01-01', 'b', 'c', 'd')",
           "INSERT INTO audit (who, number, " + rest + "1, 'b', 'c', 'd')",
           "INSERT INTO audit OVERRIDING SYSTEM VALUE SELECT * FROM audit",
           "UPDATE audit SET role = 'plain_worker'", "UPDATE audit SET who = 'bob', text = ''",
           "DELETE FROM audit", "TRUNCATE audit", "ALTER TABLE audit ALTER role DROP DEFAULT",
           "SET SESSION AUTHORIZATION recald"}) {
    EXPECT_FALSE(own->run(forged)) << forged;
  }
  const std::string claim = "INSERT INTO audit (who, " + rest + "'retire_site', 'tower', '')";
  EXPECT_TRUE(own->run_all(claim));
  EXPECT_TRUE(own->run_all("SET ROLE recald_worker; " + claim));
  EXPECT_EQ(
      ask("SELECT role, now() - time < '1 hour' FROM audit WHERE who = 'ann' ORDER BY number"),
      "recald|t\nplain_worker|t\nplain_worker|t\n");
  const auto entries = audited(*connection_, 3);
  ASSERT_TRUE(entries) << entries.error().message;
  EXPECT_EQ(entries->at(0).role, "plain_worker");
  EXPECT_EQ(entries->at(2).role, "recald");
  const auto reader = open_as("recald_read", "plain_reader");
  EXPECT_TRUE(audited(*reader, 1));
  EXPECT_FALSE(reader->run(claim));
  leave("plain_reader");
  leave("plain_worker");
}

// A record of version 1, as it was made before: its rows stay, and what its roles could do is taken
// back.
TEST_F(Record, AnEarlierVersionIsBroughtUpToDate) {
  for (const char* step :
       {"ALTER TABLE audit DROP COLUMN role", "ALTER TABLE audit ALTER COLUMN time DROP DEFAULT",
        "UPDATE fleet SET schema_version = 1", "GRANT INSERT ON audit TO recald_worker",
        "DELETE FROM audit",
        "INSERT INTO audit (time, who, action, subject, text) VALUES ('2024-01-01', 'ann', "
        "'put_site', 'tower', 'version 1')"}) {
    ASSERT_EQ(ask(step).find("ERROR"), std::string::npos) << step;
  }
  const auto old = check_schema(*connection_);
  ASSERT_FALSE(old);
  EXPECT_EQ(old.error().code, ErrorCode::unsupported);
  EXPECT_THAT(old.error().message, HasSubstr("schema 1"));
  EXPECT_THAT(old.error().message, HasSubstr("recald fleet init"));
  for (int again = 0; again < 2; ++again) EXPECT_EQ(make_schema(*connection_).value(), "");
  EXPECT_TRUE(check_schema(*connection_));
  ASSERT_TRUE(put_site(*connection_, described("annex"), "bob"));
  EXPECT_EQ(ask("SELECT who, role, subject FROM audit ORDER BY number"),
            "ann||tower\nbob|recald|annex\n");
  const auto own = open_as("recald_worker", "late_worker");
  EXPECT_FALSE(
      own->run("INSERT INTO audit (time, who, action, subject, text) VALUES (now(), 'a', "
               "'b', 'c', 'd')"));
  leave("late_worker");
}

TEST_F(Record, ASiteIsVersionedByItsContent) {
  auto site = described("tower");
  auto put = put_site(*connection_, site, "ann");
  ASSERT_TRUE(put) << put.error().message;
  EXPECT_EQ(put->number, 1);
  EXPECT_FALSE(put->is_new);
  site.files["weather/city.epw"] += "c";
  put = put_site(*connection_, site, "bob");
  ASSERT_TRUE(put);
  EXPECT_EQ(put->number, 2);
  EXPECT_TRUE(put->is_new);
  site.calibrate_from = month_of(2024, 3);  // none of its files
  put = put_site(*connection_, site, "bob");
  ASSERT_TRUE(put);
  EXPECT_EQ(put->number, 3);
  // What both have is there once.
  EXPECT_EQ(ask("SELECT count(*) FROM file"), "3\n");

  const auto first = site_of_version(*connection_, "tower", 1);
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_EQ(first->files, described("tower").files);
  EXPECT_EQ(first->calibrate_from, month_of(2024, 2));
  EXPECT_EQ(first->latitude_deg, 40.7);
  EXPECT_EQ(first->longitude_deg, std::nullopt);
  EXPECT_EQ(first->outputs, described("tower").outputs);
  EXPECT_EQ(site_of_version(*connection_, "tower", 9).error().code, ErrorCode::not_found);

  const auto entries = audited(*connection_, 2);
  ASSERT_TRUE(entries);
  ASSERT_EQ(entries->size(), 2u);
  EXPECT_EQ(entries->front().who, "bob");
  EXPECT_EQ(entries->front().subject, "tower");
  EXPECT_THAT(entries->front().text, HasSubstr("version 3"));
}

TEST_F(Record, SitesSayWhenTheyWereHeard) {
  ASSERT_TRUE(put_site(*connection_, described("annex"), "ann"));
  ASSERT_TRUE(send(intervals(0, 3)));
  const auto found = sites(*connection_);
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->size(), 2u);
  EXPECT_EQ(found->at(0).site.id, "annex");
  EXPECT_EQ(found->at(0).heard, std::nullopt);
  EXPECT_EQ(found->at(1).site.name, "Tower");
  EXPECT_EQ(found->at(1).heard, kNow);
  EXPECT_EQ(found->at(1).newest, kMarch + 3 * kQuarter);
}

TEST_F(Record, ARetiredSiteKeepsItsDataAndSendsNoMore) {
  ASSERT_TRUE(send(intervals(0, 3)));
  ASSERT_TRUE(retire_site(*connection_, "tower", "ann"));
  EXPECT_EQ(retire_site(*connection_, "tower", "ann").error().code, ErrorCode::not_found);
  EXPECT_EQ(send(intervals(3, 3)).error().code, ErrorCode::not_found);
  EXPECT_TRUE(sites(*connection_)->empty());
  EXPECT_TRUE(watermarks(*connection_)->empty());
  EXPECT_EQ(ask("SELECT count(*) FROM interval"), "3\n");
  ASSERT_TRUE(put_site(*connection_, described("tower"), "ann"));
  EXPECT_TRUE(send(intervals(3, 3)));
}

}  // namespace
}  // namespace recald::record
