#include "daemon/site/savings/measure_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

#include "adapters/system/files/regular_file.hpp"
#include "core/model/parameter_library.hpp"

namespace recald::daemon {
namespace {

using savings::Achieved;
using savings::Change;
using savings::ChangeKind;
using savings::Measure;

/// One number, or the least, likeliest and most that may come of it.
Achieved read_achieved(TomlReader& table) {
  if (!table.is_list("value")) {
    const double value = table.required_number("value");
    return {value, value, value};
  }
  const auto three = table.numbers("value", 3);
  if (!three) return {0.0, 0.0, 0.0};
  const Achieved by{three->at(0), three->at(1), three->at(2)};
  if (!(by.min <= by.mode && by.mode <= by.max)) {
    table.problem_at("value", "'value' must be [min, mode, max] in ascending order");
    return {0.0, 0.0, 0.0};
  }
  return by;
}

/// Refuses a target value that no building has.
void check_value(const Change& change, TomlReader& table) {
  if (change.kind == ChangeKind::scale && change.by.min < 0.0) {
    table.problem_at("value", fmt::format("'value' is {}; a factor is at least 0", change.by.min));
  }
  const auto library = model::parameter_library();
  const auto known =
      std::ranges::find(library, change.parameter, &model::ParameterDefinition::name);
  if (change.kind != ChangeKind::set || known == library.end()) return;
  if (change.by.min < known->least || change.by.max > known->most) {
    const bool is_low = change.by.min < known->least;
    table.problem_at("value",
                     fmt::format("'value' sets {} to {}, which is not possible: it is at "
                                 "{} {}",
                                 change.parameter, is_low ? change.by.min : change.by.max,
                                 is_low ? "least" : "most", is_low ? known->least : known->most));
  }
}

/// Whether the fields are in the model is seen when it is run.
void check_energyplus(const Change& change, const ModelConfig& model, TomlReader& table) {
  if (change.parameter.empty() == change.targets.empty()) {
    table.problem(
        "say what the measure changes, either as 'parameter' (one of the site file's or of the "
        "library) or as 'targets' in the EnergyPlus model, such as "
        "\"Lights/*/watts_per_floor_area\"");
    return;
  }
  const auto is_it = [&](const auto& known) { return known.name == change.parameter; };
  if (change.parameter.empty() || std::ranges::any_of(model.parameters, is_it) ||
      std::ranges::any_of(model::parameter_library(), is_it)) {
    return;
  }
  table.problem_at("parameter", model::find_parameter(change.parameter).error().message);
}

Change read_change(TomlReader& table, const SiteConfig& site) {
  Change change{.parameter = table.text_or("parameter", ""),
                .targets = table.one_or_more("targets").value_or(std::vector<std::string>{}),
                .kind = ChangeKind::scale,
                .by = {}};
  const std::vector<std::string_view> kinds{model::kChangeKindNames.begin(),
                                            model::kChangeKindNames.end()};
  if (const auto kind = table.word("change", kinds)) {
    change.kind = static_cast<ChangeKind>(std::ranges::find(kinds, *kind) - kinds.begin());
  } else if (!table.has("change")) {
    table.problem("'change' is missing: \"set\", \"scale\" or \"add\"");
  }
  change.by = read_achieved(table);
  if (site.model->energyplus) {
    check_energyplus(change, *site.model, table);
  } else if (table.has("targets")) {
    table.problem_at(
        "targets",
        fmt::format("'targets' are objects of an EnergyPlus file, and this site's model is {}; "
                    "name a 'parameter' such as \"lighting_use\" instead",
                    name_of(site.model->kind)));
  } else if (change.parameter.empty()) {
    table.problem("'parameter' is missing: what the measure changes, such as \"lighting_use\"");
  } else if (const auto found = model::find_parameter(change.parameter); !found) {
    table.problem_at("parameter", found.error().message);
  }
  check_value(change, table);
  table.finish();
  return change;
}

Measure read_measure(TomlReader& table, const SiteConfig& site) {
  Measure measure{.name = table.required_text("name"),
                  .cost = table.number("cost", kNotNegative),
                  .changes = {}};
  if (measure.cost && site.tariff.currency.empty()) {
    table.problem_at("cost",
                     "'cost' needs the site's [tariff], without which nothing says what is saved");
  }
  for (TomlReader& change : table.tables("change")) {
    measure.changes.push_back(read_change(change, site));
  }
  if (measure.changes.empty()) {
    table.problem(
        fmt::format("measure '{}' has no [[measure.change]]: say what it changes", measure.name));
  }
  table.finish();
  return measure;
}

}  // namespace

tl::expected<std::vector<Measure>, Problems> parse_measures(std::string_view text,
                                                            const std::string& name,
                                                            const SiteConfig& site) {
  Problems problems;
  std::vector<Measure> measures;
  try {
    const toml::table table = parse_toml(text, name);
    TomlReader root{table, name, "", problems};
    std::set<std::string> names;
    for (TomlReader& one : root.tables("measure")) {
      measures.push_back(read_measure(one, site));
      if (!names.insert(measures.back().name).second) {
        one.problem_at("name", fmt::format("two measures are called '{}'; give each a name of its "
                                           "own",
                                           measures.back().name));
      }
    }
    if (measures.empty() && problems.empty()) {
      root.problem("there is no [[measure]] with a name and a [[measure.change]]");
    }
    root.finish();
  } catch (const toml::parse_error& error) {
    problems.push_back(syntax_problem(name, error));
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return measures;
}

tl::expected<std::vector<Measure>, Problems> load_measures(const std::filesystem::path& file,
                                                           const SiteConfig& site) {
  if (const auto is_file = system::require_file(file, "file of measures"); !is_file) {
    return tl::unexpected(Problems{is_file.error().message});
  }
  std::ifstream in{file};
  return parse_measures(std::string{std::istreambuf_iterator<char>{in}, {}},
                        file.filename().string(), site);
}

}  // namespace recald::daemon
