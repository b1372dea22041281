#include "daemon/site/setup/site_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "core/text/ascii.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"

namespace recald::daemon {
std::string toml_text(std::string_view text) {
  std::string out{'"'};
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte == 0x7F) {
      out += fmt::format("\\u{:04X}", byte);
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string relative_path(const std::filesystem::path& file, const std::filesystem::path& folder) {
  std::error_code failed;
  const auto whole = [&failed](const std::filesystem::path& one) {
    // What is not there yet is relative to where the command runs.
    const auto absolute = std::filesystem::absolute(one, failed);
    return failed ? one : std::filesystem::weakly_canonical(absolute, failed);
  };
  const auto from = whole(folder);
  const auto to = whole(file);
  const auto path = failed ? std::filesystem::path{} : to.lexically_relative(from);
  const bool is_far = path.empty() || path.string().starts_with("../../..");
  return is_far ? to.string() : path.string();
}

namespace {

constexpr std::size_t kIdMax = 40;
constexpr double kManyZeros = 0.05;
constexpr double kManyFrozen = 0.01;
constexpr double kManyNegative = 0.005;

/// Letters, digits and hyphens; German umlauts as people write them without.
std::string slug(std::string_view text) {
  std::string out;
  const auto hyphen = [&] {
    if (!out.empty() && out.back() != '-') out += '-';
  };
  for (std::size_t i = 0; i < text.size() && out.size() < kIdMax; ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (std::isalnum(byte) != 0) {
      out += to_lower(text[i]);
    } else if (byte == 0xC3 && i + 1 < text.size()) {
      switch (static_cast<unsigned char>(text[++i])) {
        case 0xA4:
        case 0x84:
          out += "ae";
          break;
        case 0xB6:
        case 0x96:
          out += "oe";
          break;
        case 0xBC:
        case 0x9C:
          out += "ue";
          break;
        case 0x9F:
          out += "ss";
          break;
        default:
          hyphen();
      }
    } else {
      hyphen();
    }
  }
  out.resize(std::min(out.size(), kIdMax));
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out;
}

/// Ids of a site: no two alike.
class Ids {
 public:
  std::string take(std::string_view name, std::string_view otherwise) {
    std::string id = slug(name);
    if (id.empty()) id = slug(otherwise);
    if (id.empty()) id = "meter";
    std::string one = id;
    for (int number = 2; !taken_.insert(one).second; ++number) {
      one = fmt::format("{}-{}", id.substr(0, kIdMax - 4), number);
    }
    return one;
  }

 private:
  std::set<std::string> taken_;
};

/// Lines of a table, their comments in one column.
class Lines {
 public:
  void head(std::string_view text) { text_ += fmt::format("{}\n", text); }
  void comment(std::string_view text) { text_ += fmt::format("# {}\n", printable(text)); }
  void key(std::string_view name, const std::string& value, std::string_view why = {}) {
    const std::string line = fmt::format("{} = {}", name, value);
    if (why.empty()) {
      text_ += line + "\n";
    } else {
      text_ += fmt::format("{:<32} # {}\n", line, printable(why));
    }
  }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

std::string_view separator_word(char separator) {
  switch (separator) {
    case '\t':
      return "tab";
    case ';':
      return ";";
    case '|':
      return "|";
    default:
      return ",";
  }
}

std::string duration(std::chrono::seconds length) {
  return length == std::chrono::hours{1} ? "1h" : fmt::format("{}m", length.count() / 60);
}

bool is_supported_interval(std::chrono::seconds length) {
  const auto minutes = length.count() / 60;
  return std::set<std::int64_t>{1, 5, 10, 15, 30, 60}.contains(minutes);
}

std::string list_text(const std::vector<std::string>& texts) {
  std::vector<std::string> quoted;
  for (const std::string& text : texts) quoted.push_back(toml_text(text));
  return fmt::format("[{}]", fmt::join(quoted, ", "));
}

/// A text, or a list of them.
std::string one_or_list(const std::string& first, const std::vector<std::string>& further) {
  if (further.empty()) return toml_text(first);
  std::vector<std::string> texts{toml_text(first)};
  for (const std::string& one : further) texts.push_back(toml_text(one));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string_view format_word(table::Container container) {
  switch (container) {
    case table::Container::xlsx:
      return "xlsx";
    case table::Container::green_button:
      return "green_button";
    case table::Container::nem12:
      return "nem12";
    case table::Container::influx:
      return "influx";
    case table::Container::json:
      return "json";
    case table::Container::text:
      break;
  }
  return "table";
}

void write_names(const SurveyedMeter& meter, Lines& lines) {
  lines.key("name_in_file", one_or_list(meter.name_in_file, meter.further_names),
            meter.further_names.empty() ? "" : meter.parts_because);
}

void write_times(const SurveyedExport& one, const table::TableShape& shape, Lines& lines) {
  if (shape.layout != table::Layout::rows) {
    lines.key("layout", toml_text(table::to_string(shape.layout)), one.layout_because);
  }
  if (shape.layout == table::Layout::column_a_time) return;
  lines.key("time_column", toml_text(shape.time_column));
}

void write_shape(const SurveyedExport& one, const SurveyedMeter& meter, Lines& lines) {
  const table::TableGuess& guess = *one.table;
  const table::TableShape& shape = guess.shape;
  lines.key("format", toml_text(format_word(shape.container)));
  if (table::describes_itself(shape.container)) {
    write_names(meter, lines);
    if (shape.unit_column.empty()) {
      lines.key("unit", toml_text(meter.unit.value), meter.unit.because);
    }
    return;
  }
  if (shape.container == table::Container::xlsx) {
    lines.key("sheet", toml_text(shape.sheet));
  } else if (shape.container == table::Container::text) {
    lines.key("separator", toml_text(separator_word(shape.separator)));
  }
  write_times(one, shape, lines);
  if (!shape.clock_column.empty()) lines.key("clock_column", toml_text(shape.clock_column));
  if (shape.clock_format != table::ClockFormat::time) {
    lines.key("clock_format", toml_text(table::to_string(shape.clock_format)),
              one.clock_format_because);
  }
  lines.key("time_format", toml_text(table::to_string(shape.time_format)),
            guess.time_format_because);
  if (!shape.timezone.empty()) lines.key("timezone", toml_text(shape.timezone), one.clock_because);
  lines.key("decimal", toml_text(std::string{shape.decimal}), guess.decimal_because);
  if (!shape.meter_column.empty()) {
    lines.key("meter_column", one_or_list(shape.meter_column, shape.further_meter_columns));
    write_names(meter, lines);
  }
  if (shape.layout == table::Layout::rows) {
    lines.key("column", one_or_list(meter.column, meter.further_columns),
              meter.further_columns.empty() ? "" : meter.parts_because);
  }
  if (!shape.unit_column.empty()) {
    lines.key("unit_column", toml_text(shape.unit_column));
  } else {
    lines.key("unit", toml_text(meter.unit.value), meter.unit.because);
  }
  if (shape.flag_column.empty()) return;
  lines.key("flag_column", toml_text(shape.flag_column), "says how good each value is");
  if (!shape.missing_flags.empty()) {
    lines.key("missing_flags", list_text(shape.missing_flags), "beside these is no data");
  }
  if (!shape.estimated_flags.empty()) {
    lines.key("estimated_flags", list_text(shape.estimated_flags), "… and these are estimates");
  }
}

std::string per_cent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

void write_limits(const SurveyedMeter& meter, Lines& lines) {
  if (meter.is_register) {
    const RegisterVerdict& shown = meter.as_register;
    lines.key("rated_kW", fmt::format("{}", shown.rated_kW),
              "guessed: half as much again as it ever rose by; the most that it can draw");
    const std::string_view resets = shown.resets == metering::Resets::daily ? ", resets = \"day\""
                                    : shown.resets == metering::Resets::monthly
                                        ? ", resets = \"month\""
                                        : "";
    const std::string zone =
        shown.reset_zone.empty() ? "" : ", reset_zone = " + toml_text(shown.reset_zone);
    lines.key("counter", fmt::format("{{ unit = \"kWh\"{}{} }}", resets, zone),
              shown.because.empty() ? "as the feed says" : shown.because);
    if (shown.runs_back) lines.key("negative_is_valid", "true", "it counts back what is delivered");
    return;
  }
  if (meter.utility.value == metering::Utility::electricity && meter.zero_share > kManyZeros) {
    lines.key("zero_run_max", "\"31d\"",
              fmt::format("guessed: {} of its values are zero, taken for no load; else they are no "
                          "data",
                          per_cent(meter.zero_share)));
  }
  if (meter.negative_share > kManyNegative) {
    lines.key("negative_is_valid", "true",
              fmt::format("{} of its values are negative", per_cent(meter.negative_share)));
  }
  if (meter.frozen_share > kManyFrozen) {
    lines.key("stuck_max", "\"31d\"",
              fmt::format("guessed: {} of its values are in runs of equal ones, taken for a coarse "
                          "or steady meter; else it is frozen there",
                          per_cent(meter.frozen_share)));
  }
}

/// One file, or a list of them.
std::string files_value(const std::vector<std::filesystem::path>& files,
                        const std::filesystem::path& folder) {
  std::vector<std::string> texts;
  for (const auto& file : files) texts.push_back(toml_text(relative_path(file, folder)));
  return texts.size() == 1 ? texts.front() : fmt::format("[{}]", fmt::join(texts, ", "));
}

void write_meter(const SurveyedExport& one, const SurveyedMeter& meter, const std::string& id,
                 const std::filesystem::path& folder, Lines& lines) {
  lines.head("\n[[meter]]");
  lines.key("id", toml_text(id));
  lines.key("utility", toml_text(metering::to_string(meter.utility.value)), meter.utility.because);
  lines.key("file", files_value(one.files, folder));
  if (one.table) {
    write_shape(one, meter, lines);
  } else {
    lines.key("name_in_file", toml_text(meter.name_in_file));
  }
  if (meter.needs_heating_value) {
    lines.key("gas_kWh_per_m3", "10.55", "guessed: the bill says it; 1000 BTU/ft3 are 10.35");
  }
  if (is_supported_interval(meter.interval)) {
    lines.key("interval", toml_text(duration(meter.interval)),
              meter.is_of_other_steps ? "one that its rows fill; they come at other steps"
                                      : "the commonest step");
  }
  if (meter.grid_tolerance > std::chrono::seconds{0} && !meter.is_register) {
    lines.key("grid_tolerance", toml_text(fmt::format("{}s", meter.grid_tolerance.count())),
              "its stamps lie beside the starts of its intervals");
  }
  lines.key("stamps", meter.stamps.value == csv::Stamps::end ? "\"end\"" : "\"start\"",
            meter.stamps.because);
  write_limits(meter, lines);
}

struct PlacedMeter {
  const SurveyedExport* in;
  const SurveyedMeter* meter;
};

/// Sums are looked for among meters alike, of whatever file.
std::vector<FoundSum> sums_of(const std::vector<PlacedMeter>& all) {
  std::vector<FoundSum> sums;
  std::set<std::size_t> seen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].meter->is_register || !seen.insert(i).second) continue;
    std::vector<std::size_t> alike{i};
    for (std::size_t k = i + 1; k < all.size(); ++k) {
      const SurveyedMeter& other = *all[k].meter;
      if (other.is_register || other.interval != all[i].meter->interval ||
          other.utility.value != all[i].meter->utility.value) {
        continue;
      }
      alike.push_back(k);
      seen.insert(k);
    }
    std::vector<const SampledReadings*> samples;
    for (const std::size_t k : alike) samples.push_back(&all[k].meter->samples);
    for (FoundSum sum : find_sums(samples)) {
      sum.sum = alike[sum.sum];
      for (std::size_t& part : sum.parts) part = alike[part];
      sums.push_back(std::move(sum));
    }
  }
  return sums;
}

void add_guesses(const PlacedMeter& placed, const std::string& id, SiteDraft& draft) {
  const SurveyedMeter& meter = *placed.meter;
  const auto is_guess = [](const std::string& because) { return because.starts_with("guessed"); };
  const auto add = [&](std::string sentence) { draft.guesses.push_back(std::move(sentence)); };
  if (is_guess(meter.utility.because)) {
    add(fmt::format("{}: taken for {}.", id, metering::to_string(meter.utility.value)));
  } else if (meter.utility.because.find(", though") != std::string::npos) {
    add(fmt::format("{}: taken for {}, {}.", id, metering::to_string(meter.utility.value),
                    meter.utility.because));
  }
  if (is_guess(meter.unit.because)) add(fmt::format("{}: taken to be in kWh.", id));
  if (is_guess(meter.stamps.because)) {
    add(fmt::format("{}: stamps are taken for the {} of intervals.", id,
                    meter.stamps.value == csv::Stamps::end ? "ends" : "starts"));
  }
  if (meter.is_register) {
    const metering::Resets resets = meter.as_register.resets;
    add(fmt::format("{}: taken for a cumulative register{}; rated_kW = {}.", id,
                    resets == metering::Resets::daily     ? " that is set to zero each day"
                    : resets == metering::Resets::monthly ? " that is set to zero each month"
                                                          : "",
                    meter.as_register.rated_kW));
  }
  if (meter.needs_heating_value) {
    add(fmt::format("{}: a volume of gas, taken for 10.55 kWh/m3.", id));
  }
}

}  // namespace

SiteDraft draft_site(std::span<const SurveyedExport> exports, const std::filesystem::path& folder,
                     const Guess<std::string>& timezone) {
  SiteDraft draft;
  Lines lines;
  lines.comment(
      "Written by recald init. What a comment calls guessed is worth a look; every key is");
  lines.comment("explained in daemon/examples/every-key.toml.");
  lines.head("\n[site]");
  Ids site_ids;
  const std::string of_folder = folder.filename().string();
  const bool is_named = !of_folder.empty() && of_folder != "." && of_folder != "..";
  lines.key("id",
            toml_text(site_ids.take(
                is_named ? of_folder : exports.front().files.front().stem().string(), "site")),
            is_named ? "from the folder's name" : "from the file's name");
  lines.key("timezone", toml_text(timezone.value), timezone.because);
  Ids ids;
  std::vector<PlacedMeter> all;
  for (const SurveyedExport& one : exports) {
    for (const SurveyedMeter& meter : one.meters) {
      all.push_back({&one, &meter});
      draft.meter_ids.push_back(ids.take(meter.name, one.files.front().stem().string()));
    }
  }
  const std::vector<FoundSum> sums = sums_of(all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    write_meter(*all[i].in, *all[i].meter, draft.meter_ids[i], folder, lines);
    const auto sum = std::ranges::find(sums, i, &FoundSum::sum);
    if (sum != sums.end()) {
      std::vector<std::string> parts;
      for (const std::size_t part : sum->parts) parts.push_back(toml_text(draft.meter_ids[part]));
      const std::string list = fmt::format("{}", fmt::join(parts, ", "));
      lines.comment(
          fmt::format("It is the sum of others: sum_of = [{}] in the place of the file "
                      "says the same.",
                      list));
      lines.comment("Let a model have the sum or its parts among its outputs, not both.");
      draft.guesses.push_back(
          fmt::format("{}: at every stamp the sum of {}.", draft.meter_ids[i], list));
    }
    add_guesses(all[i], draft.meter_ids[i], draft);
  }
  for (const SurveyedExport& one : exports) {
    draft.guesses.insert(draft.guesses.end(), one.notes.begin(), one.notes.end());
  }
  draft.text = lines.take();
  return draft;
}

}  // namespace recald::daemon
