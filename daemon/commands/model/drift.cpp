#include <chrono>

#include "adapters/system/parallel_for.hpp"
#include "adapters/views/drift/drift_json.hpp"
#include "adapters/views/drift/drift_report.hpp"
#include "adapters/views/drift/drift_words.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/generated_at.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/commands/model/calibration_options.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/drift/site_drift.hpp"
#include "daemon/site/model/active_effects.hpp"
#include "daemon/site/results/report_parts.hpp"

namespace recald::daemon {
namespace {

/// What the site file says of a period gives way: everything that was measured is looked at.
tl::expected<ModelledSite, int> open_followed_site(const DriftArguments& arguments,
                                                   const DriftOptions& options,
                                                   const Console& console) {
  return open_modelled_site(
      arguments.site, console, arguments.model,
      [&](const OpenSite& site, const Recording& recording, metering::Instant now) {
        return followed_period(site, recording, now, options.learning_months);
      });
}

}  // namespace

int run_drift(const DriftArguments& arguments, const Console& console) {
  const auto begin = std::chrono::steady_clock::now();
  DriftOptions options;
  options.learning_months = arguments.learning_months;
  options.sequential.particles = arguments.particles;
  options.sequential.anew_every_months = arguments.anew_every_months;
  auto modelled = open_followed_site(arguments, options, console);
  if (!modelled) return modelled.error();
  auto version = active_version(modelled->site.config);
  if (!version) return console.fail(version.error());
  modelled->facts.model_version = version_name(*version, modelled->facts.model_version);
  modelled->facts.seed = arguments.seed;

  const InterruptGuard guard;
  ProgressLine line{console};
  const calibration::RunContext context{.seed = arguments.seed,
                                        .executor = system::parallel_for(arguments.threads),
                                        .observer = [&](const calibration::Progress& progress) {
                                          line.show(progress);
                                          return !guard.interrupted();
                                        }};
  const auto drift = follow_site(*modelled, options, version->effects, context);
  if (!drift) return console.fail(drift.error());
  modelled->facts.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const std::string json = views::drift_json(*drift, modelled->facts);
  if (!arguments.out.empty()) {
    const auto written = views::write_drift(site_line_of(modelled->site.config), *drift,
                                            modelled->facts, generated_at(), json, arguments.out);
    if (!written) return console.fail(written.error());
  }
  console.out << (arguments.json ? json : views::drift_words(*drift));
  return kSuccess;
}

}  // namespace recald::daemon
