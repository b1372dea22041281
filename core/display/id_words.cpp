#include "core/display/id_words.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/metering/civil_time.hpp"
#include "core/model/parameter_library.hpp"
#include "core/text/ascii.hpp"

namespace recald::display {
namespace {

using Words = std::pair<std::string_view, std::string_view>;

/// By the contract's ends of an output's name, whatever their case.
constexpr auto kOutputEnds =
    std::to_array<Words>({{"_daily_kwh", "daily mean"}, {"_peak_kw", "monthly peak"}});

/// Model inputs, as weather and designs of experiments name them.
constexpr auto kInputs = std::to_array<Words>({{"dry_bulb_C", "outdoor temperature"},
                                               {"drybulb", "outdoor temperature"},
                                               {"rel_humidity_pct", "relative humidity"},
                                               {"ghi_W_m2", "solar radiation"},
                                               {"wind_dir_deg", "wind direction"},
                                               {"rh", "relative humidity"},
                                               {"wind_speed_m_s", "wind speed"},
                                               {"windspeed", "wind speed"},
                                               {"wind_dir_sin", "wind from the east"},
                                               {"wind_dir_cos", "wind from the north"},
                                               {"winddir", "wind direction"},
                                               {"out", "the outputs"}});

constexpr std::string_view kRoughness = "beta_";

bool is_upper(char c) { return 'A' <= c && c <= 'Z'; }

}  // namespace

std::string id_words(std::string_view id) {
  std::string words{id};
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string meter_label(std::string_view id) { return capitalised(id_words(id)); }

std::string output_words(std::string_view output) {
  const std::string small = to_lower(output);
  for (const auto& [end, words] : kOutputEnds) {
    if (!small.ends_with(end) || small.size() == end.size()) continue;
    output.remove_suffix(end.size());
    return id_words(output) + ", " + std::string{words};
  }
  return id_words(output);
}

std::string input_words(std::string_view input) {
  const auto* const known = std::ranges::find(kInputs, input, &Words::first);
  return known == kInputs.end() ? id_words(input) : std::string{known->second};
}

std::string parameter_words(std::string_view name) {
  const auto library = model::parameter_library();
  const auto known = std::ranges::find(library, name, &model::ParameterDefinition::name);
  if (known != library.end()) return uncapitalised(std::string{known->label});
  if (name == "lambda_delta") return "precision of the model's discrepancy";
  if (name == "lambda_eps") return "precision of the measurements";
  if (name.starts_with(kRoughness)) {
    return "roughness along " + input_words(name.substr(kRoughness.size()));
  }
  return id_words(name);
}

std::string month_words(std::string_view month) {
  static constexpr std::array<std::string_view, 12> kNames = {
      "January", "February", "March",     "April",   "May",      "June",
      "July",    "August",   "September", "October", "November", "December"};
  const auto parsed = metering::parse_month(month);
  if (!parsed) return "month " + std::string{month};
  return std::string{kNames[unsigned{parsed->month()} - 1]} + " " +
         std::to_string(int{parsed->year()});
}

std::string capitalised(std::string words) {
  if (!words.empty() && 'a' <= words[0] && words[0] <= 'z') {
    words[0] = static_cast<char>(words[0] - 'a' + 'A');
  }
  return words;
}

std::string uncapitalised(std::string words) {
  const bool is_word = words.size() > 1 && 'a' <= words[1] && words[1] <= 'z';
  if (is_word && is_upper(words[0])) words[0] = static_cast<char>(words[0] - 'A' + 'a');
  return words;
}

}  // namespace recald::display
