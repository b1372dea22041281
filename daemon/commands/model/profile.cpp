#include <fmt/format.h>

#include "adapters/system/files/write_file.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"
#include "daemon/site/results/calibration_files.hpp"

namespace recald::daemon {
namespace {

void print_profile(const model::ElectricityProfile& profile, const Console& console) {
  console.out << "hour";
  for (const char* day : model::kDayTypeNames) console.out << fmt::format("  {:>24}", day);
  console.out << "\n";
  console.out << "    ";
  for (std::size_t i = 0; i < model::kDayTypes; ++i) {
    console.out << fmt::format("  {:>8}{:>8}{:>8}", "measured", "lights", "plugs");
  }
  console.out << "   [kW]\n";
  for (int hour = 0; hour < 24; ++hour) {
    console.out << fmt::format("{:4d}", hour);
    for (std::size_t i = 0; i < model::kDayTypes; ++i) {
      const auto day = static_cast<model::DayType>(i);
      console.out << fmt::format("  {:>8.1f}{:>8.1f}{:>8.1f}", profile.measured_kW.at(day, hour),
                                 profile.loads.lights_kW.at(day, hour),
                                 profile.loads.plugs_kW.at(day, hour));
    }
    console.out << "\n";
  }
  console.out << profile.check.words << "\n";
}

}  // namespace

int run_profile(const ProfileArguments& arguments, const Console& console) {
  const auto modelled = open_modelled_site(arguments.site, console);
  if (!modelled) return modelled.error();
  const auto& [site, recording, weather, facts] = *modelled;
  const auto profile = profile_site(site.config, site.calendar, recording, weather);
  if (!profile) return console.fail(profile.error());

  if (!arguments.out.empty()) {
    if (auto made = system::make_folder(arguments.out); !made) return console.fail(made.error());
    const auto written = system::write_file(arguments.out / "profile.json", profile_json(*profile));
    if (!written) return console.fail(written.error());
  }
  if (arguments.json) {
    console.out << profile_json(*profile);
  } else {
    print_profile(*profile, console);
  }
  return kSuccess;
}

}  // namespace recald::daemon
