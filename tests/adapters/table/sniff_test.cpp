#include "adapters/table/sniff.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>

namespace recald::table::sniff_test {
namespace {

using ::testing::HasSubstr;

std::vector<KeptRow> rows_of(const std::vector<std::vector<std::string>>& cells) {
  std::vector<KeptRow> rows;
  for (const auto& row : cells) rows.push_back({rows.size() + 1, row});
  return rows;
}

std::string padded(int number) { return (number < 10 ? "0" : "") + std::to_string(number); }

/// Hours from the first of a month on: "DD/MM/2024 HH:00" or with month and day exchanged.
std::vector<std::vector<std::string>> hours(int month, int first_day, int count,
                                            bool is_month_first, const std::string& value) {
  std::vector<std::vector<std::string>> cells{{"when", "Main (kWh)"}};
  for (int hour = 0; hour < count; ++hour) {
    const std::string date = padded(first_day + hour / 24);
    const std::string parts =
        is_month_first ? padded(month) + "/" + date : date + "/" + padded(month);
    cells.push_back({parts + "/2024 " + padded(hour % 24) + ":00", value});
  }
  return cells;
}

TableGuess guess(const std::vector<std::vector<std::string>>& cells) {
  auto guessed = guess_table(rows_of(cells));
  EXPECT_TRUE(guessed.has_value()) << guessed.error().message;
  return guessed ? *guessed : TableGuess{};
}

std::string refusal(const std::vector<std::vector<std::string>>& cells) {
  const auto guessed = guess_table(rows_of(cells));
  return guessed ? "understood" : guessed.error().message;
}

TEST(Sniff, ADayAfterTheTwelfthDecides) {
  const TableGuess days = guess(hours(3, 10, 120, false, "1.5"));
  EXPECT_EQ(days.shape.time_format, TimeFormat::day_first);
  EXPECT_THAT(days.time_format_because, HasSubstr("'13/03/2024 00:00' in row 74 decides"));
  EXPECT_EQ(guess(hours(3, 10, 120, true, "1.5")).shape.time_format, TimeFormat::month_first);
}

// 1 to 5 March: the other way round the days would be months apart.
TEST(Sniff, DaysThatFollowEachOtherDecide) {
  const TableGuess days = guess(hours(3, 1, 120, false, "1.5"));
  EXPECT_EQ(days.shape.time_format, TimeFormat::day_first);
  EXPECT_FALSE(days.is_time_format_open);
  EXPECT_EQ(guess(hours(3, 1, 120, true, "1.5")).shape.time_format, TimeFormat::month_first);
  EXPECT_TRUE(guess(hours(3, 4, 24, false, "1.5")).is_time_format_open);
}

TEST(Sniff, CountedDaysAndSecondsAreTimes) {
  // From 1998, 2024, 2045 and 2100.
  for (const std::int64_t begin_s :
       {883'612'800LL, 1'704'067'200LL, 2'366'841'600LL, 4'102'444'800LL}) {
    SCOPED_TRACE(begin_s);
    std::vector<std::vector<std::string>> cells{{"Date", "kW"}};
    const double begin_days = 25'569.0 + static_cast<double>(begin_s) / 86'400.0;
    for (int i = 0; i < 20; ++i) cells.push_back({std::to_string(begin_days + i / 24.0), "5"});
    EXPECT_EQ(guess(cells).shape.time_format, TimeFormat::excel);
    for (int i = 0; i < 20; ++i) cells[i + 1][0] = std::to_string(begin_s + 900 * i);
    EXPECT_EQ(guess(cells).shape.time_format, TimeFormat::unix);
    EXPECT_TRUE(guess(cells).has_offsets);
  }
}

TEST(Sniff, TheDecimalSignIsWhatSomeValueShows) {
  EXPECT_EQ(guess(hours(3, 10, 120, false, "1,5")).shape.decimal, ',');
  EXPECT_EQ(guess(hours(3, 10, 120, false, "1,234.5")).shape.decimal, '.');
  EXPECT_EQ(guess(hours(3, 10, 120, false, "1.234,5")).shape.decimal, ',');
  EXPECT_EQ(guess(hours(3, 10, 120, false, "0,125")).shape.decimal, ',');
  EXPECT_THAT(guess(hours(3, 10, 120, false, "1,234")).decimal_because, HasSubstr("would decide"));
  EXPECT_EQ(guess(hours(3, 10, 120, false, "1,234")).shape.decimal, ',');
  EXPECT_EQ(guess(hours(3, 10, 120, false, "1.234")).shape.decimal, '.');
  auto thousands = hours(3, 10, 120, false, "1,234");
  for (std::size_t i = 1; i < thousands.size(); i += 2) thousands[i][1] = "975";
  EXPECT_EQ(guess(thousands).shape.decimal, '.');
  auto mixed = hours(3, 10, 120, false, "1,5");
  for (std::size_t i = 1; i < mixed.size(); i += 2) mixed[i][1] = "1.5";
  EXPECT_THAT(refusal(mixed), HasSubstr("change their decimal sign: row"));
}

// Values that may be thousands or thousandths are written as the prices beside them.
TEST(Sniff, OtherNumbersOfTheTableDecideTheDecimalSign) {
  for (const char* price : {"0,25", "0.25"}) {
    auto cells = hours(3, 10, 120, false, "1.234");
    cells[0].push_back("Preis (EUR)");
    for (std::size_t i = 1; i < cells.size(); ++i) cells[i].push_back(price);
    EXPECT_EQ(guess(cells).shape.decimal, price[1]);
    EXPECT_THAT(guess(cells).decimal_because, HasSubstr("as in '" + std::string{price} + "'"));
  }
}

TEST(Sniff, UnitsStandInHeadersOrBelowThem) {
  auto cells = hours(3, 10, 48, false, "1.5");
  cells[0][1] = "Main";
  cells.insert(cells.begin() + 1, {"", "MWh"});
  const TableGuess below = guess(cells);
  EXPECT_EQ(below.values.at(0).name, "Main");
  EXPECT_EQ(below.values.at(0).unit, "MWh");
  EXPECT_EQ(below.shape.time_column, "when");
}

TEST(Sniff, ColumnsOfTextAreNoMeters) {
  auto cells = hours(3, 10, 48, false, "1.5");
  cells[0].insert(cells[0].end(), {"Status", "Main (kWh)", "Nothing",
                                   "Outdoor (\xC2\xB0"
                                   "C)"});
  for (std::size_t i = 1; i < cells.size(); ++i) {
    cells[i].insert(cells[i].end(), {i % 2 == 0 ? "A" : "E", "2", "", "21.5"});
  }
  const TableGuess found = guess(cells);
  ASSERT_EQ(found.values.size(), 2u);
  EXPECT_EQ(found.values[1].column, "#4");  // the second of that name
  EXPECT_EQ(found.shape.flag_column, "Status");
  EXPECT_EQ(found.ignored, (std::vector<std::string>{"Nothing (empty)",
                                                     "Outdoor (\xC2\xB0"
                                                     "C) (no energy)"}));
}

/// Rows of half-hours from 1 September 2025 on, with the cells that a case adds.
using Cells = std::vector<std::vector<std::string>>;
template <class AddCells>
Cells half_hours(std::vector<std::string> header, int days, AddCells&& add) {
  Cells cells{std::move(header)};
  for (int i = 0; i < 48 * days; ++i) {
    const std::string date = "2025-09-" + padded(1 + i / 48);
    const std::string time = padded(i % 48 / 2) + (i % 2 == 0 ? ":00" : ":30");
    cells.push_back(add(i, date, time));
  }
  return cells;
}

std::string load(int i) { return std::to_string(10 + i % 7) + "." + std::to_string(1 + i % 9); }

std::vector<std::string> columns_of(const TableGuess& found) {
  std::vector<std::string> columns;
  for (const GuessedColumn& value : found.values) columns.push_back(value.column);
  return columns;
}

// Every language's words for what is no meter, beside one that is.
TEST(Sniff, CostsNumbersAndOtherQuantitiesAreNoMeters) {
  struct Other {
    const char* header;
    const char* why;
    std::function<std::string(int)> cell;
  };
  const auto money = [](int i) { return "3." + std::to_string(10 + i % 80); };
  const auto constant = [](int) { return std::string{"541400000000000001"}; };
  const std::vector<Other> others{
      {"Estimated Cost Inc. Tax (p)", "money", money},
      {"Kosten (EUR)", "money", money},
      {"Co\xC3\xBBt", "money", money},
      {"Importe", "money", money},
      {"Costo", "money", money},
      {"Prijs", "money", money},
      {"Pre\xC3\xA7o", "money", money},
      {"Pris", "money", money},
      {"Kostnad", "money", money},
      {"Hinta", "money", money},
      {"Koszt", "money", money},
      {"ct/kWh", "money", money},
      {"price_kWh", "money", money},
      {"kg CO2", "emissions", money},
      {"Blindarbeit (kvarh)", "no energy", money},
      {"Reactive (kvar)", "no energy", money},
      {"Power factor", "no energy", [](int i) { return "0.9" + std::to_string(i % 9); }},
      {"U1 (V)", "no energy", [](int i) { return "23" + std::to_string(i % 9) + ".5"; }},
      {"I1 [A]", "no energy", money},
      {"Lufttemperatur", "no energy", money},
      {"", "the number of a row", [](int i) { return std::to_string(i); }},
      {"Nr.", "the number of a row", [](int i) { return std::to_string(i + 1); }},
      {"EAN", "an identifier", constant},
      {"Z\xC3\xA4hlernummer", "an identifier", constant},
      {"PRM", "an identifier", constant},
      {"Point", "an identifier", constant},
      {"Tariff", "a tariff", [](int i) { return std::to_string(1 + i / 24 % 2); }},
      {"Status", "a status", [](int i) { return std::to_string(i % 3); }},
      {"Month", "part of the date", [](int) { return std::string{"9"}; }},
      {"Hour", "part of the time", [](int i) { return std::to_string(i % 48 / 2); }},
  };
  for (const Other& other : others) {
    SCOPED_TRACE(other.header);
    const TableGuess found = guess(half_hours(
        {"Time", other.header, "Main (kWh)", "Sub (kWh)"}, 5,
        [&](int i, const std::string& date, const std::string& time) {
          return std::vector<std::string>{date + " " + time, other.cell(i), load(i), load(i / 2)};
        }));
    EXPECT_EQ(columns_of(found), (std::vector<std::string>{"Main (kWh)", "Sub (kWh)"}));
    const std::string name = *other.header == '\0' ? "#2" : other.header;
    EXPECT_EQ(found.ignored, std::vector<std::string>{name + " (" + other.why + ")"});
  }
}

// A coarse load of a column called meter is one, numbers of a column called meter are names.
TEST(Sniff, AColumnCalledMeterHasAmountsOrNames) {
  const TableGuess coarse = guess(half_hours(
      {"Time", "Meter 1"}, 20, [](int i, const std::string& date, const std::string& time) {
        return std::vector<std::string>{date + " " + time, std::to_string(100 * (i % 5))};
      }));
  EXPECT_EQ(columns_of(coarse), std::vector<std::string>{"Meter 1"});
  for (const int first : {1, 100200300}) {
    const TableGuess names = guess(half_hours(
        {"Time", "Meter", "kWh"}, 20, [&](int i, const std::string& date, const std::string& time) {
          return std::vector<std::string>{date + " " + time.substr(0, 2) + ":00",
                                          std::to_string(first + i % 2), load(i)};
        }));
    EXPECT_EQ(names.shape.meter_column, "Meter");
    EXPECT_EQ(columns_of(names), std::vector<std::string>{"kWh"});
  }
}

// Names that sound like costs or numbers, of columns that are meters.
TEST(Sniff, WhatHasAUnitOfEnergyIsAMeter) {
  for (const char* header :
       {"Tarif HP (kWh)", "Meter 4711 (kWh)", "Kostenstelle 12 (kWh)", "EV charge (kWh)",
        "Z\xC3\xA4hler Nr. 3 [kWh]", "Register 1.8.0 kWh"}) {
    const TableGuess found = guess(half_hours(
        {"Time", header}, 3, [&](int i, const std::string& date, const std::string& time) {
          return std::vector<std::string>{date + " " + time, std::to_string(100 + i % 50)};
        }));
    ASSERT_EQ(found.values.size(), 1u) << header;
    EXPECT_EQ(found.values[0].unit, "kWh") << header;
  }
}

TEST(Sniff, UnitsAreTakenFromWhereTheyStandAndNeverMadeUp) {
  const auto row = [](const std::string& unit) {
    return [unit](int i, const std::string& date, const std::string& time) {
      return std::vector<std::string>{date + " " + time, load(i) + unit};
    };
  };
  const auto unit_of = [](Cells cells) {
    const TableGuess found = guess(cells);
    return found.values.empty() ? GuessedColumn{} : found.values.front();
  };
  EXPECT_EQ(unit_of(half_hours({"Time", "Value"}, 2, row(""))).unit, "");
  EXPECT_EQ(unit_of(half_hours({"Time", "Value"}, 2, row(" kW"))).unit, "kW");
  EXPECT_EQ(unit_of(half_hours({"Time", "Value"}, 2, row(" kW"))).unit_because, "as its cells say");
  Cells above = half_hours({"Time", "Value"}, 2, row(""));
  above.insert(above.begin(), {"Unit\xC3\xA9", "W"});
  EXPECT_EQ(unit_of(above).unit, "W");
  EXPECT_EQ(unit_of(above).unit_because, "as row 1 says");
  above[0] = {"Messwerte in kW"};
  EXPECT_EQ(unit_of(above).unit, "kW");
  above[0] = {"Einheit", "kW"};
  above.insert(above.begin(), {"Einheit", "kWh"});
  EXPECT_EQ(unit_of(above).unit, "");  // two are none
  Cells pair = half_hours({"Time", "Value"}, 2, row(""));
  pair.insert(pair.begin(), {"Type", "Unite"});
  pair.insert(pair.begin() + 1, {"Courbe", "W"});
  EXPECT_EQ(unit_of(pair).unit, "W");
  const Cells column = half_hours(
      {"Time", "Value", "Einheit"}, 2, [](int i, const std::string& date, const std::string& time) {
        return std::vector<std::string>{date + " " + time, load(i), "MWh"};
      });
  EXPECT_EQ(unit_of(column).unit, "MWh");
  // A flag of one letter is no watt.
  const Cells flag = half_hours({"Time", "Value", "Status"}, 2,
                                [](int i, const std::string& date, const std::string& time) {
                                  return std::vector<std::string>{date + " " + time, load(i), "W"};
                                });
  EXPECT_EQ(unit_of(flag).unit, "");
}

TEST(Sniff, ADateAboveTheTableIsNoData) {
  Cells cells =
      half_hours({"Contador", "Data", "Hora", "Consumo (kW)"}, 3,
                 [](int i, const std::string& date, const std::string& time) {
                   return std::vector<std::string>{"000001234500000", date, time, load(i)};
                 });
  cells.insert(cells.begin(), {{"CPE", "PT0002", "", ""},
                               {"Data de inicio", "2025-09-01", "", ""},
                               {"Data de fim", "2025-09-30", "", ""}});
  const TableGuess found = guess(cells);
  EXPECT_EQ(found.shape.time_column, "Data");
  EXPECT_EQ(found.shape.clock_column, "Hora");
  EXPECT_EQ(columns_of(found), std::vector<std::string>{"Consumo (kW)"});
  EXPECT_EQ(found.values[0].unit, "kW");
}

TEST(Sniff, TwoRowsOfNamesAreJoined) {
  const auto rows = [](int i, const std::string& date, const std::string& time) {
    return std::vector<std::string>{date + " " + time, load(i), load(i / 2), load(i / 3),
                                    load(i / 5)};
  };
  Cells groups =
      half_hours({"Time", "Import (kWh)", "Export (kWh)", "Import (kWh)", "Export (kWh)"}, 3, rows);
  groups.insert(groups.begin(), {"", "Main", "", "AHU", ""});
  const TableGuess found = guess(groups);
  ASSERT_EQ(found.values.size(), 4u);
  EXPECT_EQ(found.shape.time_column, "Time");
  EXPECT_EQ(found.values[0].name, "Main Import");
  EXPECT_EQ(found.values[3].name, "AHU Export");
  EXPECT_EQ(found.values[3].unit, "kWh");
  EXPECT_EQ(columns_of(found),
            (std::vector<std::string>{"Import (kWh)", "Export (kWh)", "#4", "#5"}));
  Cells both = half_hours({"[yyyy]", "Energy", "Energy", "Energy", "Energy"}, 3, rows);
  both.insert(both.begin(), {"Time", "A", "B", "C", "D"});
  const TableGuess named = guess(both);
  EXPECT_EQ(columns_of(named), (std::vector<std::string>{"A", "B", "C", "D"}));
  EXPECT_EQ(named.values[1].name, "B Energy");
}

// Whole numbers of one meter say nothing of another's three digits.
TEST(Sniff, TheDecimalSignIsThatOfItsOwnColumn) {
  for (const char sign : {'.', ','}) {
    const auto cells = [&](bool has_small) {
      return half_hours({"time", "Main (Wh)", "Gas (m³)"}, 3,
                        [&](int i, const std::string& date, const std::string& time) {
                          const std::string value =
                              std::string{"2"} + sign + std::to_string(100 + 37 * i % 900);
                          return std::vector<std::string>{
                              date + " " + time, std::to_string(1916 + i % 50),
                              has_small && i % 3 == 0 ? std::to_string(300 + i) : value};
                        });
    };
    EXPECT_EQ(guess(cells(false)).shape.decimal, sign);
    EXPECT_EQ(guess(cells(true)).shape.decimal, sign == '.' ? ',' : '.');
  }
}

TEST(Sniff, ATimeWithoutAHeaderIsFound) {
  const TableGuess one = guess(
      half_hours({"", "main_kWh"}, 2, [](int i, const std::string& date, const std::string& time) {
        return std::vector<std::string>{date + " " + time + ":00+02:00", load(i)};
      }));
  EXPECT_EQ(one.shape.time_column, "#1");
  EXPECT_EQ(columns_of(one), std::vector<std::string>{"main_kWh"});
  EXPECT_EQ(one.values[0].unit, "kWh");
}

// What nobody sees is no name, and two columns whose names look alike are told apart.
TEST(Sniff, AHeaderOfUnseenCharactersIsNone) {
  for (const std::string unseen : {"\b\b", "\xE2\x80\x8B", "\xC2\xA0\x01", "\t"}) {
    const TableGuess blank = guess(half_hours(
        {"time", unseen, "a" + unseen + " kWh", "a kWh" + unseen}, 2,
        [](int i, const std::string& date, const std::string& time) {
          return std::vector<std::string>{date + " " + time, load(i), load(i + 1), load(i + 5)};
        }));
    for (const GuessedColumn& value : blank.values) EXPECT_NE(value.column, "");
    EXPECT_THAT(columns_of(blank), ::testing::Contains("#2"));
  }
  const TableGuess alike =
      guess(half_hours({"time", "a\n(kWh)", "a (kWh)"}, 2,
                       [](int i, const std::string& date, const std::string& time) {
                         return std::vector<std::string>{date + " " + time, load(i), load(i + 9)};
                       }));
  EXPECT_EQ(columns_of(alike), (std::vector<std::string>{"a (kWh)", "#3"}));
}

TEST(Sniff, StartsAreRatherTakenThanEnds) {
  struct Names {
    const char* from;
    const char* to;
  };
  for (const Names& names : {Names{"Start", "End"},
                             {"von", "bis"},
                             {"Van", "Tot"},
                             {"D\xC3\xA9"
                              "but",
                              "Fin"},
                             {"Inicio", "Fin"},
                             {"Od", "Do"},
                             {"Alku", "Loppu"},
                             {"Fra", "Til"},
                             {"Inizio", "Fine"},
                             {"In\xC3\xAD"
                              "cio",
                              "Fim"}}) {
    const auto rows = [](int i, const std::string& date, const std::string& time) {
      const std::string end = "2025-09-" + padded(1 + (i + 1) / 48) + " " +
                              padded((i + 1) % 48 / 2) + ((i + 1) % 2 == 0 ? ":00" : ":30");
      return std::vector<std::string>{end, date + " " + time, load(i)};
    };
    const TableGuess found = guess(half_hours({names.to, names.from, "kWh"}, 3, rows));
    EXPECT_EQ(found.shape.time_column, names.from);
    EXPECT_EQ(found.stamps, csv::Stamps::start) << names.from;
    const TableGuess end = guess(half_hours(
        {names.to, "x", "kWh"}, 3, [](int i, const std::string& date, const std::string& time) {
          return std::vector<std::string>{date + " " + time, "", load(i)};
        }));
    EXPECT_EQ(end.stamps, csv::Stamps::end) << names.to;
  }
  const TableGuess logged = guess(half_hours(
      {"Logged", "Start", "kWh"}, 3, [](int i, const std::string& date, const std::string& time) {
        return std::vector<std::string>{date + " " + time + ":59", date + " " + time, load(i)};
      }));
  EXPECT_EQ(logged.shape.time_column, "Start");
  // Times that never change are of the query, not of the rows.
  const TableGuess query = guess(half_hours(
      {"_start", "_time", "kW"}, 3, [](int i, const std::string& date, const std::string& time) {
        return std::vector<std::string>{"2025-09-01T00:00:00Z", date + "T" + time + ":00Z",
                                        load(i)};
      }));
  EXPECT_EQ(query.shape.time_column, "_time");
}

TEST(Sniff, NumbersOfHoursAndIntervalsAreAClock) {
  for (const int labels : {24, 48, 96}) {
    Cells cells{{"Fecha", "Hora", "Consumo (kWh)"}};
    for (int date = 1; date <= 9; ++date) {
      for (int label = 1; label <= labels; ++label) {
        cells.push_back(
            {"0" + std::to_string(date) + "/09/2025", std::to_string(label), load(label)});
      }
    }
    const TableGuess found = guess(cells);
    EXPECT_EQ(found.shape.clock_column, "Hora");
    EXPECT_EQ(found.labels_a_day, labels);
    EXPECT_EQ(found.shape.interval, std::chrono::seconds{86'400 / labels});
    EXPECT_EQ(found.stamps, csv::Stamps::start);
    ASSERT_EQ(found.values.size(), 1u);
  }
}

// "W" behind a name is watts, unless others have the wings of a building.
TEST(Sniff, AWBehindANameIsAUnitOrTheWest) {
  const auto units = [](const char* first, const char* second) {
    const TableGuess found = guess(half_hours(
        {"Time", first, second}, 2, [](int i, const std::string& date, const std::string& time) {
          return std::vector<std::string>{date + " " + time, load(i), load(i / 2)};
        }));
    return found.values.at(0).unit + found.values.at(1).unit;
  };
  EXPECT_EQ(units("main_W", "sub_W"), "WW");
  EXPECT_EQ(units("wing_W", "wing_E"), "");
  EXPECT_EQ(units("Wing W", "Roof"), "");
}

TEST(Sniff, AClockOfFourFiguresIsOne) {
  Cells cells{{"Datum", "Uhrzeit", "Ost (kWh)"}};
  for (int i = 0; i < 96 * 3; ++i) {
    cells.push_back(
        {"2025090" + std::to_string(1 + i / 96), padded(i % 96 / 4) + padded(i % 4 * 15), load(i)});
  }
  EXPECT_EQ(guess(cells).shape.clock_column, "Uhrzeit");
}

TEST(Sniff, TimesAtWhichRowsWereWrittenAreNotTheirs) {
  const TableGuess found = guess(half_hours(
      {"Revision date", "Usage date", "kWh"}, 3,
      [](int i, const std::string& date, const std::string& time) {
        return std::vector<std::string>{"2025-09-09 10:" + padded(i % 60) + ":" + padded(i / 60),
                                        date + " " + time, load(i)};
      }));
  EXPECT_EQ(found.shape.time_column, "Usage date");
}

TEST(Sniff, TimesThatEndAt24MayCountHours) {
  Cells cells{{"cups", "fecha", "hora", "consumo_kWh"}};
  for (int date = 1; date <= 9; ++date) {
    for (int hour = 1; hour <= 24; ++hour) {
      cells.push_back({"ES01XX", "2025/09/0" + std::to_string(date), padded(hour) + ":00", "1,5"});
    }
  }
  const TableGuess found = guess(cells);
  EXPECT_EQ(found.shape.clock_column, "hora");
  EXPECT_EQ(found.labels_a_day, 24);
  EXPECT_EQ(found.shape.clock_format, ClockFormat::time);
}

TEST(Sniff, PowerBesideEnergyIsOneMeter) {
  const auto both = [](double factor, const char* power) {
    return half_hours({"Time", "Main energy (kWh)", power}, 3,
                      [factor](int i, const std::string& date, const std::string& time) {
                        const double kWh = 10.0 + i % 7;
                        return std::vector<std::string>{date + " " + time, std::to_string(kWh),
                                                        std::to_string(factor * kWh)};
                      });
  };
  const TableGuess one = guess(both(2.0, "Main demand (kW)"));
  EXPECT_EQ(columns_of(one), std::vector<std::string>{"Main energy (kWh)"});
  EXPECT_EQ(one.ignored,
            std::vector<std::string>{"Main demand (kW) (the load of 'Main energy (kWh)')"});
  EXPECT_TRUE(one.notes.empty());
  // By its name of the same load, but not its mean: told.
  const TableGuess peak = guess(both(2.6, "Main demand (kW)"));
  EXPECT_EQ(peak.values.size(), 1u);
  ASSERT_EQ(peak.notes.size(), 1u);
  EXPECT_THAT(peak.notes[0], HasSubstr("is not its mean: see row 2"));
  // Of another name and with other values: another meter.
  EXPECT_EQ(guess(both(2.6, "Chiller (kW)")).values.size(), 2u);
  EXPECT_EQ(guess(both(2.0, "P (kW)")).values.size(), 1u);
}

TEST(Sniff, RangesAndZonesAreTimes) {
  const TableGuess range = guess(
      half_hours({"Period", "kWh"}, 3, [](int i, const std::string& date, const std::string& time) {
        return std::vector<std::string>{date + " " + time + " to " + date + " 23:59", load(i)};
      }));
  EXPECT_EQ(range.stamps, csv::Stamps::start);
  EXPECT_EQ(range.stamps_because, "each says from when to when");
  const TableGuess zone = guess(
      half_hours({"Time", "kWh"}, 3, [](int i, const std::string& date, const std::string& time) {
        return std::vector<std::string>{date + " " + time + " EDT", load(i)};
      }));
  EXPECT_TRUE(zone.has_offsets);
  // 00:00-01:00 behind a date with the year first may be an offset; so many are none.
  Cells glued{{"Time", "kWh"}};
  for (int i = 0; i < 48; ++i) {
    glued.push_back({"2025-09-0" + std::to_string(1 + i / 24) + " " + padded(i % 24) + ":00-" +
                         padded(i % 24 + 1) + ":00",
                     load(i)});
  }
  EXPECT_THAT(refusal(glued), HasSubstr("put blanks around the hyphen"));
}

TEST(Sniff, ARefusalNamesTheNearestCell) {
  Cells cells{{"when", "kWh"}};
  for (int i = 0; i < 30; ++i) cells.push_back({"Q" + std::to_string(i) + " 12:15 soon", load(i)});
  EXPECT_THAT(refusal(cells), HasSubstr("nearest to one is 'Q14 12:15 soon' in row 16"));
  EXPECT_THAT(refusal(hours(3, 10, 48, false, "on")),
              HasSubstr("there are 'Main (kWh)' (text, such as 'on' in row 2)"));
}

TEST(Sniff, SeparatorsAreWhatCutsMostLines) {
  EXPECT_EQ(guess_separator(std::vector<std::string>{"a;b", "1,5;2,5", "1,5;3,5"}), ';');
  EXPECT_EQ(guess_separator(std::vector<std::string>{"Report", "", "a,b", "1,2", "3,4", "5,6"}),
            ',');
  EXPECT_EQ(guess_separator(std::vector<std::string>{"a\tb", "1,5\t2"}), '\t');
  EXPECT_EQ(guess_separator(std::vector<std::string>{"sep=;", "a,b;c", "1,2;3"}), ';');
  // A comma within quotes sets no cells apart, and lines above the table may be many.
  EXPECT_EQ(guess_separator(
                std::vector<std::string>{"a|b", "\"9/1/2025, 12:00\"|1", "\"9/1/2025, 12:15\"|2"}),
            '|');
  EXPECT_EQ(guess_separator(
                std::vector<std::string>{"Report", "of a", "building", "a;b;c", "1;2;3", "4;5;6"}),
            ';');
}

TEST(Sniff, WhatIsNoTableSaysWhy) {
  EXPECT_EQ(refusal({}), "it is empty");
  EXPECT_THAT(refusal({{"a", "b"}, {"1", "2"}}), HasSubstr("no column has dates and times"));
  EXPECT_THAT(refusal(hours(3, 10, 48, false, "on")), HasSubstr("no column has numbers"));
}

}  // namespace
}  // namespace recald::table::sniff_test
