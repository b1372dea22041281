#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "daemon/commands/commands.hpp"
#include "daemon/commands/model/design_input.hpp"
#include "daemon/site/calibrate/design_calibration.hpp"
#include "daemon/site/calibrate/design_origin.hpp"
#include "daemon/site/results/design_files.hpp"

namespace recald::daemon {
namespace {

/// The design with some of its parameters; what the others do becomes its error.
Result<regression::DesignData> chosen_data(const doe::DesignFolder& design,
                                           const std::string& parameters) {
  regression::DesignData data = design_data(design);
  if (parameters == "all") return data;
  const auto chosen = TRY(named_parameters(design.parameters, parameters));
  data.theta = data.theta(Eigen::all, chosen).eval();
  data.parameters.clear();
  for (const int j : chosen) {
    data.parameters.push_back(design.parameters[static_cast<std::size_t>(j)].name);
  }
  const auto place_of = [&](int parameter) {
    return static_cast<int>(std::ranges::find(chosen, parameter) - chosen.begin());
  };
  const int count = static_cast<int>(chosen.size());
  std::vector<regression::ParameterCap> caps;
  for (const regression::ParameterCap& cap : data.caps) {
    const regression::ParameterCap moved{place_of(cap.parameter), place_of(cap.under), cap.gap};
    if (moved.parameter < count && moved.under < count) caps.push_back(moved);
  }
  data.caps = std::move(caps);
  return data;
}

}  // namespace

int run_metamodel(const MetamodelArguments& arguments, const Console& console) {
  const auto begin = std::chrono::steady_clock::now();
  const auto design = open_design_folder(arguments.design, console);
  if (!design) return design.error();
  const auto origin = check_origin(*design);
  if (!origin) return console.fail(origin.error());
  const auto data = chosen_data(*design, arguments.parameters);
  if (!data) return console.fail(data.error());
  const auto fitted = fit_metamodel(*data, metamodel_options(arguments.design, arguments.seed));
  if (!fitted) return console.fail(fitted.error());
  auto facts = facts_of_files(design->files, "design");
  if (!facts) return console.fail(facts.error());
  facts->seed = arguments.seed;
  facts->design_runs = static_cast<int>(design->runs.size());
  facts->wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  std::vector<std::string> notes = design->notes;
  notes.insert(notes.end(), origin->notes.begin(), origin->notes.end());
  notes.insert(notes.end(), fitted->notes.begin(), fitted->notes.end());
  std::vector<regression::CheckedOutput> checked;
  if (!arguments.check.empty()) {
    const auto check = open_design_folder({.folder = arguments.check}, console);
    if (!check) return check.error();
    const auto other = chosen_data(*check, arguments.parameters);
    if (!other) return console.fail(other.error());
    auto outputs = check_metamodel(*fitted, *data, *other);
    if (!outputs) return console.fail(outputs.error());
    checked = std::move(*outputs);
  }
  const std::string json = metamodel_json(*fitted, notes, *facts, checked);
  if (auto written = write_result(arguments.out, "metamodel.json", json); !written) {
    return console.fail(written.error());
  }
  console.out << (arguments.json ? json : metamodel_table(*fitted, notes, checked));
  return kSuccess;
}

}  // namespace recald::daemon
