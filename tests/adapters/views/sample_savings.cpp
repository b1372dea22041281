#include "tests/adapters/views/sample_savings.hpp"

namespace recald::views {

SavingsData sample_savings() {
  SavingsData data{.title = "What measures would save at Depot",
                   .site = {"depot", "Depot", "Europe/Zurich"},
                   .generated_at = "2023-01-01",
                   .headline = "Better lamps: saves 9,360 EUR a year.",
                   .cards = {},
                   .months = {},
                   .months_before = {},
                   .months_after = {},
                   .not_known = {"Weather is that of the calibration months."},
                   .notices = {},
                   .provenance = {.seed = 7}};
  data.cards.push_back(
      {.title = "Better <b>lamps</b>",
       .sentence = "Saves 9,360 EUR a year.",
       .caption = "Better lamps: what it saves",
       .amounts = {{"Electricity", "kWh a year", 25000.0, 31200.0, 38000.0, 0.08, 1.0},
                   {"Heating", "kWh a year", -9000.0, -6000.0, -2000.0, {}, 0.013}},
       .notes = {"The lights' share is taken from the drawings."}});
  return data;
}

SavingsData realised_savings() {
  SavingsData data = sample_savings();
  using std::chrono::year;
  data.months_before = {"2021-01", "2021-02"};
  data.months_after = {"2022-07"};
  data.months = {{.label = "Chilled water, daily mean",
                  .unit = "kWh/day",
                  .trust = "Band: without the measure.",
                  .months = {{year{2022} / 7, 540.0, 600.0, 660.0, 480.0}},
                  .alarms = {}}};
  return data;
}

}  // namespace recald::views
