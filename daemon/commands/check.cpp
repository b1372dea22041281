#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/model/parameter_library.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/open_site.hpp"

namespace recald::daemon {
namespace {

std::string duration_words(std::chrono::seconds length) {
  return length.count() % 3600 == 0 ? fmt::format("{} h", length.count() / 3600)
                                    : fmt::format("{} min", length.count() / 60);
}

void print_meters(const SiteConfig& site, const Console& console) {
  for (const MeterConfig& config : site.meters) {
    const metering::Meter& meter = config.meter;
    console.out << fmt::format(
        "  meter {:<16} {:<14} {} ('{}', {}-stamped, interval {})\n", meter.id,
        metering::to_string(meter.utility), config.file.string(), config.name_in_file,
        config.stamps == csv::Stamps::end ? "end" : "start",
        config.interval ? duration_words(*config.interval) : "as the file shows");
  }
}

/// Problems that only show once several tables are seen together.
std::vector<std::string> check_model(const SiteConfig& site, const Console& console, bool json) {
  std::vector<std::string> problems;
  for (const ParameterConfig& config : site.model->parameters) {
    const auto definition = model::find_parameter(config.name);
    const auto parameter = model::make_parameter(**definition, *site.building, config.prior);
    if (!parameter) {
      problems.push_back(site.file.filename().string() + ": " + parameter.error().message);
      continue;
    }
    if (json) continue;
    const Prior& prior = parameter->prior;
    console.out << fmt::format("  parameter {:<20} triangular {:.4g} / {:.4g} / {:.4g} {}\n",
                               parameter->name, prior.min(), prior.mode(), prior.max(),
                               parameter->unit);
  }
  return problems;
}

std::vector<std::string> check_files(const SiteConfig& site) {
  std::vector<std::string> problems;
  const auto require = [&](const std::filesystem::path& file, std::string_view what) {
    if (std::filesystem::is_regular_file(file)) return;
    problems.push_back(fmt::format("{}: {} '{}' does not exist", site.file.filename().string(),
                                   what, file.string()));
  };
  for (const MeterConfig& config : site.meters) {
    require(config.file, fmt::format("the file of meter '{}',", config.meter.id));
  }
  if (site.weather) require(site.weather->file, "the weather file");
  return problems;
}

}  // namespace

int run_check(const SiteArguments& arguments, const Console& console) {
  const auto site = load_site(arguments.site);
  std::vector<std::string> problems = site ? check_files(*site) : site.error();
  if (site && !arguments.json) {
    console.out << fmt::format("{} ({}), {}\n", site->name, site->id, site->timezone);
    print_meters(*site, console);
  }
  if (site && site->model) {
    const auto more = check_model(*site, console, arguments.json);
    problems.insert(problems.end(), more.begin(), more.end());
  }
  if (arguments.json) {
    console.out << nlohmann::ordered_json{{"ok", problems.empty()}, {"problems", problems}}.dump(2)
                << "\n";
  }
  if (!problems.empty()) return console.fail(problems);
  if (!arguments.json) console.out << "ok\n";
  return kSuccess;
}

}  // namespace recald::daemon
