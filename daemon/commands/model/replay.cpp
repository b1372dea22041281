#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "adapters/system/files/write_file.hpp"
#include "adapters/system/time_zone_release.hpp"
#include "core/display/unit.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/generated_at.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/results/calibration_files.hpp"
#include "daemon/site/results/meters_report.hpp"

namespace recald::daemon {
namespace {

Result<std::optional<metering::Day>> parse_option(const char* option, const std::string& text) {
  if (text.empty()) return std::optional<metering::Day>{};
  const auto day = metering::parse_day(text);
  if (!day) return failure(ErrorCode::malformed, std::string{option} + ": " + day.error().message);
  return std::optional{*day};
}

std::string figure_line(const display::MeterUnits& units, const metering::Meter& meter,
                        const metering::MonthlyFigure& figure, metering::Instant now) {
  std::string line = fmt::format("{}  {:<16} ", metering::to_string(figure.month), meter.id);
  const auto& daily = units.daily;
  line += std::isfinite(figure.daily_average_kWh)
              ? fmt::format("{:>10.1f} {}", daily.shown(figure.daily_average_kWh), daily.name)
              : fmt::format("{:>10} {}", "-", daily.name);
  line += figure.peak ? fmt::format("  peak {:>8.1f} {}", units.power.shown(figure.peak->kW),
                                    units.power.name)
                      : fmt::format("  peak {:>8} {}", "-", units.power.name);
  line += fmt::format("  measured {:5.1f} %  closed {}", 100.0 * figure.coverage,
                      metering::to_string(now));
  if (!figure.usable) line += "  unusable: " + figure.unusable_because;
  return line;
}

nlohmann::ordered_json summary_json(const SiteConfig& site, const Recording& recording) {
  nlohmann::ordered_json meters = nlohmann::ordered_json::array();
  for (const MeterRecord& record : recording.meters) {
    nlohmann::ordered_json findings = nlohmann::ordered_json::array();
    for (const metering::DataFinding& finding : record.findings)
      findings.push_back(finding.sentence);
    meters.push_back({{"meter", record.meter.id},
                      {"interval_s", record.meter.interval.count()},
                      {"interval_inferred", record.in_file && record.in_file->interval_inferred},
                      {"readings", record.rows.readings},
                      {"months", record.figures.size()},
                      {"findings", findings}});
  }
  std::uint64_t bad_lines = 0;
  for (const FileIssues& file : recording.files) bad_lines += file.issues.total;
  return {{"site", site.id},
          {"readings", recording.readings},
          {"bad_lines", bad_lines},
          {"meters", meters}};
}

/// A site file cannot begin as a recording does.
bool is_recording(const std::filesystem::path& file) {
  if (std::error_code ignored; !std::filesystem::is_regular_file(file, ignored)) return false;
  std::ifstream in{file, std::ios::binary};
  return in.get() == '{';
}

std::string source_line(const MeterConfig& config, const MeterRecord& record) {
  if (config.source == MeterSource::sum) {
    return fmt::format("{}: {} readings every {} s ({})\n", record.meter.id, record.counts.accepted,
                       record.meter.interval.count(), sum_words(config));
  }
  if (!record.in_file) {
    return fmt::format("{}: {} readings every {} s (read live)\n", record.meter.id,
                       record.counts.accepted, record.meter.interval.count());
  }
  return fmt::format("{}: {} readings every {} s ({})\n", record.meter.id, record.rows.readings,
                     record.meter.interval.count(),
                     record.in_file->interval_inferred ? "inferred from the file" : "as declared");
}

}  // namespace

int run_replay(const ReplayArguments& arguments, const Console& console) {
  if (is_recording(arguments.site)) return run_replay_recording(arguments, console);
  const auto from = parse_option("--from", arguments.from);
  if (!from) return console.misused(from.error().message);
  const auto to = parse_option("--to", arguments.to);
  if (!to) return console.misused(to.error().message);
  if (*from && *to && **to < **from) {
    return console.misused(
        fmt::format("--to {} is before --from {}", arguments.to, arguments.from));
  }
  const auto site = open_site(arguments.site);
  if (!site) return console.fail(site.error());

  VirtualClock clock{metering::Instant{}};
  const auto recording =
      record_site(*site, {*from, *to}, clock,
                  [&](const metering::Meter& meter, const metering::MonthlyFigure& figure,
                      metering::Instant now) {
                    if (arguments.json) return;
                    const auto units = display::meter_units(site->config.units, meter.utility);
                    console.out << figure_line(units, meter, figure, now) << "\n";
                  });
  if (!recording) return console.fail(recording.error());
  for (std::size_t i = 0; i < recording->meters.size(); ++i) {
    console.err << source_line(site->config.meters[i], recording->meters[i]);
  }
  print_data_words(*recording, console);
  if (!arguments.out.empty()) {
    if (auto made = system::make_folder(arguments.out); !made) return console.fail(made.error());
    const auto written = system::write_file(arguments.out / "months.csv",
                                            months_csv(*recording, system::time_zone_release()));
    if (!written) return console.fail(written.error());
    const auto page = render_meters_of(*site, *recording, generated_at());
    if (!page) return console.fail(page.error());
    if (auto saved = system::write_file(arguments.out / "meters.html", *page); !saved) {
      return console.fail(saved.error());
    }
  }
  if (arguments.json) console.out << summary_json(site->config, *recording).dump(2) << "\n";
  return kSuccess;
}

}  // namespace recald::daemon
