/// What ids are called where a person reads them. Files for machines keep the ids.
#pragma once

#include <string>
#include <string_view>

namespace recald::display {

/// "chilled_water" → "chilled water"
[[nodiscard]] std::string id_words(std::string_view id);

/// As a heading: "chilled_water" → "Chilled water"
[[nodiscard]] std::string meter_label(std::string_view id);

/// Of a model's output, as the contract names them: "chilled_water_daily_kWh" → "chilled water,
/// daily mean", "chilled_water_peak_kW" → "chilled water, monthly peak". Another name: as
/// `id_words`.
[[nodiscard]] std::string output_words(std::string_view output);

/// Of a model's input: "dry_bulb_C" → "outdoor temperature". Another name: as `id_words`.
[[nodiscard]] std::string input_words(std::string_view input);

/// Of a parameter: what the library calls it, "cooling_setpoint" → "cooling set-point, occupied
/// hours". Of a hyper-parameter: "beta_dry_bulb_C" → "roughness along outdoor temperature". Another
/// name: as `id_words`.
[[nodiscard]] std::string parameter_words(std::string_view name);

/// A month as results name it: "2021-07" → "July 2021". A month without a year, "7" → "month 7".
[[nodiscard]] std::string month_words(std::string_view month);

/// As a heading or at the start of a sentence: "chilled water" → "Chilled water".
[[nodiscard]] std::string capitalised(std::string words);

/// Inside a sentence: "Chilled water" → "chilled water". An abbreviation stays: "U-factors", "AHU".
[[nodiscard]] std::string uncapitalised(std::string words);

}  // namespace recald::display
