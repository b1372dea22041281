#include "adapters/table/flags.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "adapters/table/delimited.hpp"
#include "adapters/table/green_button.hpp"
#include "adapters/table/read_table.hpp"
#include "adapters/table/sniff.hpp"

namespace recald::table::flags_test {
namespace {

using metering::Reading;
using metering::Reason;
using metering::Validity;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

FlagMeanings meanings(const std::vector<FlagCount>& flags) { return meanings_of(flags); }

std::vector<std::string> names(const std::vector<FlagCount>& flags) {
  std::vector<std::string> all;
  for (const FlagCount& one : flags) all.push_back(one.flag);
  return all;
}

TEST(Flags, LettersMeanWhatThoseBesideThemMake) {
  const auto german = meanings({{"W", 100, 1}, {"E", 5, 0}, {"F", 9, 9}});
  EXPECT_THAT(german.missing, ElementsAre("F"));
  EXPECT_THAT(german.estimated, ElementsAre("E"));
  const auto nem12 =
      meanings({{"A", 100, 0}, {"E52", 5, 0}, {"F16", 9, 0}, {"S14", 3, 0}, {"N", 4, 4}});
  EXPECT_THAT(nem12.missing, ElementsAre("N"));
  EXPECT_THAT(nem12.estimated, ElementsAre("E52", "F16", "S14"));
  EXPECT_THAT(meanings({{"R", 100, 0}, {"E", 5, 0}}).unknown, IsEmpty());
  EXPECT_THAT(meanings({{"M", 100, 0}, {"E", 5, 0}}).unknown, IsEmpty());
  EXPECT_THAT(meanings({{"A", 100, 0}, {"M", 5, 5}}).missing, ElementsAre("M"));
}

// What no table knows is named, never guessed.
TEST(Flags, UnknownOnesAreNamed) {
  const auto found = meanings({{"A", 100, 0}, {"Q7", 5, 5}, {"F", 3, 1}, {"K", 1, 0}});
  EXPECT_THAT(names(found.unknown), ElementsAre("Q7", "K"));
  EXPECT_THAT(names(meanings({{"F", 3, 1}, {"K", 1, 0}}).unknown), ElementsAre("F", "K"));
  EXPECT_THAT(meanings({{"W", 3, 0}, {"", 40, 0}}).unknown, IsEmpty());
}

TEST(Flags, WordsBesideThatOfWhatIsMissing) {
  for (const char* flag : {"Em falta", "Valor em falta", "Sin dato", "value missing", "NO DATA",
                           "Brak odczytu", "Keine Daten", "ei saatavilla", "Pas de données"}) {
    EXPECT_THAT(meanings({{"OK", 100, 0}, {flag, 5, 5}}).missing, ElementsAre(flag));
  }
  for (const char* flag : {"no error", "Kein Ausfall", "sans absent", "OFF"}) {
    EXPECT_THAT(meanings({{"OK", 100, 0}, {flag, 5, 5}}).missing, IsEmpty());
  }
}

// Beside a flag the value counts for nothing, or as an estimate; drawn rows, truth known.
TEST(Flags, RowsAreReadAsTheirFlagsSay) {
  struct Words {
    const char* header;
    const char* measured;
    const char* estimated;
    const char* missing;
  };
  for (const Words& words :
       {Words{"Status", "W", "E", "F"}, Words{"Quality", "Actual", "Estimated", "Missing"},
        Words{"Metodo obtencion", "Real", "Estimada", "Falta"},
        Words{"Validatiestatus", "Uitgelezen", "Geschat", "Ontbreekt"},
        Words{"Qualité", "Réelle", "Estimée", "Manquante"},
        Words{"Status", "{ok}", "est", "{fault}"}, Words{"Stato", "Reale", "Stimata", "Mancante"},
        Words{"Tila", "Mitattu", "Arvio", "Puuttuu"},
        Words{"Statusi", "Zmierzony", "Szacowany", "Brak"}}) {
    SCOPED_TRACE(words.header);
    std::mt19937 random{7};
    std::string text = std::string{"Time;Value (kWh);"} + words.header + "\n";
    std::vector<KeptRow> head{{1, {"Time", "Value (kWh)", words.header}}};
    std::vector<int> kinds;
    for (int i = 0; i < 300; ++i) {
      kinds.push_back(random() % 5 == 0 ? 1 + static_cast<int>(random() % 2) : 0);
      const char* flag = kinds.back() == 0   ? words.measured
                         : kinds.back() == 1 ? words.estimated
                                             : words.missing;
      const std::string value = kinds.back() == 2 && i % 2 == 0 ? "0" : std::to_string(2 + i % 9);
      const std::string stamp = "2025-09-" + std::string{i / 24 < 9 ? "0" : ""} +
                                std::to_string(i / 24 + 1) + " " + (i % 24 < 10 ? "0" : "") +
                                std::to_string(i % 24) + ":00";
      text += stamp + ";" + value + ";" + flag + "\n";
      head.push_back({static_cast<std::uint64_t>(i + 2), {stamp, value, flag}});
    }
    auto guess = guess_table(head);
    ASSERT_TRUE(guess.has_value()) << guess.error().message;
    EXPECT_EQ(guess->shape.flag_column, words.header);
    EXPECT_EQ(guess->shape.meter_column, "");
    ASSERT_EQ(guess->values.size(), 1u);

    const auto calendar = metering::LocalCalendar::open("Etc/UTC");
    const auto read = [&](const csv::ReadingsSink& sink, ClockFacts& facts) {
      const auto rows = delimited_rows(csv::bytes_of(text), ';');
      const TableMeter meter{{.name = "main"}, "Value (kWh)", "kWh"};
      return read_table(*rows, "x.csv", guess->shape, {&meter, 1}, *calendar, sink, &facts);
    };
    ClockFacts facts;
    ASSERT_TRUE(read({}, facts).has_value());
    const FlagMeanings found = meanings_of(facts.flags);
    EXPECT_THAT(found.missing, ElementsAre(words.missing));
    EXPECT_THAT(found.estimated, ElementsAre(words.estimated));
    guess->shape.missing_flags = found.missing;
    guess->shape.estimated_flags = found.estimated;
    std::vector<Reading> readings;
    ClockFacts again;
    ASSERT_TRUE(
        read({.on_meter = {}, .on_reading = [&](const Reading& r) { readings.push_back(r); }},
             again)
            .has_value());
    ASSERT_EQ(readings.size(), kinds.size());
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      EXPECT_EQ(std::isnan(readings[i].mean_kW), kinds[i] == 2);
      EXPECT_EQ(has(readings[i].reasons, Reason::estimated), kinds[i] == 1);
      EXPECT_EQ(readings[i].validity == Validity::scaled, kinds[i] == 1);
    }
  }
}

// A status beside a column of meters' names, or one that never changes, is neither names nor flags
// of anything.
TEST(Flags, AColumnOfNamesIsNone) {
  std::vector<KeptRow> head{{1, {"Time", "Meter", "Value (kWh)"}}};
  for (int i = 0; i < 100; ++i) {
    head.push_back({static_cast<std::uint64_t>(i + 2),
                    {"2025-09-0" + std::to_string(1 + i / 48) + " " + (i / 2 % 24 < 10 ? "0" : "") +
                         std::to_string(i / 2 % 24) + ":00",
                     i % 2 == 0 ? "East" : "West", std::to_string(1 + i % 7)}});
  }
  const auto guess = guess_table(head);
  ASSERT_TRUE(guess.has_value());
  EXPECT_EQ(guess->shape.flag_column, "");
  EXPECT_EQ(guess->shape.meter_column, "Meter");
}

TEST(Flags, AGreenButtonFeedSaysItsQuality) {
  std::string feed = "<feed><entry><content><IntervalBlock>";
  for (int i = 0; i < 50; ++i) {
    feed += "<IntervalReading><timePeriod><duration>3600</duration><start>" +
            std::to_string(1'756'684'800 + 3600 * i) + "</start></timePeriod><value>" +
            std::to_string(1000 + i) + "</value>" +
            (i % 5 == 0 ? "<ReadingQuality><quality>8</quality></ReadingQuality>" : "") +
            "</IntervalReading>";
  }
  feed += "</IntervalBlock></content></entry></feed>";
  auto parsed = parse_green_button(csv::bytes_of(feed));
  ASSERT_TRUE(parsed.has_value()) << parsed.error().message;
  const std::string name = parsed->meters[0].name;
  const auto rows = feed_rows(std::move(*parsed));
  const TableMeter meter{{.name = name}, "value", ""};
  std::vector<Reading> readings;
  const auto calendar = metering::LocalCalendar::open("Etc/UTC");
  const csv::ReadingsSink sink{.on_meter = {},
                               .on_reading = [&](const Reading& r) { readings.push_back(r); }};
  ASSERT_TRUE(read_table(*rows, "x.xml", green_button_shape(), {&meter, 1}, *calendar, sink));
  ASSERT_EQ(readings.size(), 50u);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(readings[i].validity, i % 5 == 0 ? Validity::scaled : Validity::ok);
  }
}

}  // namespace
}  // namespace recald::table::flags_test
