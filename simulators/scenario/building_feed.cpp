#include "simulators/scenario/building_feed.hpp"

#include "simulators/feed/feed_files.hpp"
#include "simulators/feed/write_file.hpp"
#include "simulators/scenario/scenario_files.hpp"

namespace recald::simulators {
namespace {

Result<void> write_twin(const BuildingFeedOptions& options, const Simulated& with,
                        const metering::LocalCalendar& calendar) {
  const Scenario twin = twin_of(options.scenario);
  const auto without = TRY(simulate(twin, options.seed, calendar));
  const Feeds feeds = read_feeds(twin, options.seed, without, calendar);
  const auto written =
      write_file(options.out / "twin_readings.csv", readings_csv(without.recording, feeds.meters));
  if (!written) return written;
  return write_file(options.out / "footprint.csv",
                    footprint_csv(with.recording, plates_of(twin.drawings),
                                  footprint_kW(with, without, calendar)));
}

}  // namespace

Result<std::size_t> write_building_feed(const BuildingFeedOptions& options) {
  TRY(make_folder(options.out));
  const Scenario& scenario = options.scenario;
  const auto calendar = TRY(metering::LocalCalendar::open(scenario.drawings.time_zone));
  // The smallest file first, so that an unwritable folder is found before the simulation.
  TRY(write_file(options.out / "site.toml", site_toml(scenario)));
  const auto simulated = TRY(simulate(scenario, options.seed, calendar));
  const Recording& recording = simulated.recording;
  const Feeds feeds = read_feeds(scenario, options.seed, simulated, calendar);
  const std::string truth =
      truth_json(scenario, options.seed, simulated, feeds.meters, feeds.weather, calendar);

  Result<void> written =
      write_file(options.out / "readings.csv", readings_csv(recording, feeds.meters));
  if (written) {
    written = write_file(options.out / "weather.csv", weather_csv(recording, feeds.weather));
  }
  if (written) written = write_file(options.out / "truth.json", truth);
  if (written && options.twin) written = write_twin(options, simulated, calendar);
  if (!written) return tl::unexpected(written.error());
  return recording.power.size();
}

}  // namespace recald::simulators
