#include "simulators/feed/building_feed.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "simulators/feed/feed_files.hpp"

namespace recald::simulators {
namespace {

Result<void> write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (file) return {};
  return failure(ErrorCode::io_failed, "cannot write " + path.string() + ": " +
                                           std::strerror(errno) +
                                           "; choose a folder with --out that can be written");
}

}  // namespace

Result<std::size_t> write_building_feed(const BuildingFeedOptions& options) {
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error) {
    return failure(ErrorCode::io_failed, "cannot make the folder " + options.out.string() + ": " +
                                             error.message() + "; choose another with --out");
  }
  // The smallest file first: an unwritable folder is found before seconds of simulation.
  if (const auto written = write_file(options.out / "site.toml", site_toml(options.period));
      !written) {
    return tl::unexpected(written.error());
  }
  const Truth truth = draw_truth(options.seed);
  const auto recording = record(truth, options.period, options.seed);
  if (!recording) return tl::unexpected(recording.error());
  const auto read = [&](MeterKind kind) {
    return read_meter(*recording, kind, options.seed, options.with_faults);
  };
  const std::array<MeterFeed, kMeters> feeds{read(MeterKind::chilled_water),
                                             read(MeterKind::electricity), read(MeterKind::steam)};
  const WeatherFeed weather = read_weather_station(*recording, options.seed, options.with_faults);
  const auto hidden = truth_json(truth, options.period, options.seed, *recording, feeds, weather);
  if (!hidden) return tl::unexpected(hidden.error());

  Result<void> written = write_file(options.out / "readings.csv", readings_csv(*recording, feeds));
  if (written) written = write_file(options.out / "weather.csv", weather_csv(*recording, weather));
  if (written) written = write_file(options.out / "truth.json", *hidden);
  if (!written) return tl::unexpected(written.error());
  return recording->power.size();
}

}  // namespace recald::simulators
