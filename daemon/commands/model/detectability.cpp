#include "core/diagnosis/detectability.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "adapters/system/files/write_file.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/diagnose/footprint.hpp"
#include "daemon/site/model/diagnosis_input.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json visibility_json(const diagnosis::Visibility& seen) {
  return {{"detectability", seen.detectability},
          {"unprojected", seen.unprojected},
          {"absorbed_share", seen.absorbed_share}};
}

std::string detectability_json(const diagnosis::Detectability& seen,
                               const diagnosis::SiteProblem& site, const RunFacts& facts) {
  Json meters = Json::object();
  for (std::size_t g = 0; g < site.meters.size(); ++g) {
    meters[site.meters[g].id] = {{"net_share", seen.meters[g].net_share},
                                 {"moved_share", seen.meters[g].moved_share}};
  }
  const Json json = {{"detectability", seen.d_star},
                     {"grains",
                      {{"month", visibility_json(seen.month)},
                       {"day", visibility_json(seen.day)},
                       {"block", visibility_json(seen.block)}}},
                     {"meters", meters},
                     {"recald_version", facts.recald_version},
                     {"data_revision", facts.data_revision},
                     {"model_version", facts.model_version}};
  return json.dump(2) + "\n";
}

void print_words(const diagnosis::Detectability& seen, const diagnosis::SiteProblem& site,
                 const Console& console) {
  console.out << fmt::format(
      "detectability d* = {:.3g}, on four-hour data\nin units of {:g}, the spread of the scores of "
      "absent effects\n",
      seen.d_star, diagnosis::null_score_spread);
  const auto grain = [&](const char* name, const diagnosis::Visibility& one) {
    console.out << fmt::format(
        "  {:<11} d {:>8.3g}   with the base parameters known {:>8.3g}   they can imitate {:.0f} "
        "% of it\n",
        name, one.detectability, one.unprojected, 100.0 * one.absorbed_share);
  };
  grain("months", seen.month);
  grain("days", seen.day);
  grain("four hours", seen.block);
  console.out << "change of each meter, over the months to fit:\n";
  for (std::size_t g = 0; g < site.meters.size(); ++g) {
    console.out << fmt::format("  {:<16} {:+.2f} % net, {:.2f} % moved\n", site.meters[g].id,
                               100.0 * seen.meters[g].net_share,
                               100.0 * seen.meters[g].moved_share);
  }
}

}  // namespace

int run_detectability(const DetectabilityArguments& arguments, const Console& console) {
  const auto modelled = open_modelled_site(arguments.site, console, ModelKind::hourly);
  if (!modelled) return modelled.error();
  const auto& [site, recording, weather, facts] = *modelled;
  if (auto enough = require_months(site.config, recording, weather); !enough) {
    return console.fail(enough.error());
  }
  const auto twin = make_site_problem(site.config, site.calendar, recording, weather);
  if (!twin) return console.fail(twin.error());
  // Before the calibration: a wrong file is told at once.
  const auto footprint_kW = read_footprint(arguments.footprint, site.config, *twin);
  if (!footprint_kW) return console.fail(footprint_kW.error());
  const auto gauge = diagnosis::FootprintGauge::calibrate(*twin);
  if (!gauge) return console.fail(gauge.error());
  const auto seen = gauge->measure(*footprint_kW);
  if (!seen) return console.fail(seen.error());

  const std::string json = detectability_json(*seen, *twin, facts);
  if (!arguments.out.empty()) {
    if (auto made = system::make_folder(arguments.out); !made) return console.fail(made.error());
    const auto written = system::write_file(arguments.out / "detectability.json", json);
    if (!written) return console.fail(written.error());
  }
  if (arguments.json) {
    console.out << json;
  } else {
    print_words(*seen, *twin, console);
  }
  return kSuccess;
}

}  // namespace recald::daemon
