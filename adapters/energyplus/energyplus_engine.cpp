#include "adapters/energyplus/energyplus_engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <fstream>
#include <optional>
#include <set>
#include <utility>

#include "adapters/energyplus/meter_output.hpp"
#include "adapters/system/sha256.hpp"
#include "adapters/system/write_file.hpp"
#include "core/absent.hpp"

namespace recald::energyplus {
namespace {

using metering::Day;
using std::chrono::seconds;

constexpr std::size_t kKeyDigits = 20;

int year_of(metering::Month month) { return static_cast<int>(month.year()); }

/// A day on either side, because local months may begin an hour before the model's days.
std::pair<Day, Day> days_to_run(const std::vector<metering::Month>& months, int year) {
  using namespace std::chrono;
  const auto in_year = [&](metering::Month month) { return year_of(month) == year; };
  const auto first = std::ranges::find_if(months, in_year);
  const auto last = std::find_if(months.rbegin(), months.rend(), in_year);
  const sys_days begin =
      std::max(sys_days{*first / 1} - days{1}, sys_days{std::chrono::year{year} / 1 / 1});
  const sys_days end = std::min(sys_days{*last / std::chrono::last} + days{1},
                                sys_days{std::chrono::year{year} / 12 / 31});
  return {Day{begin}, Day{end}};
}

/// The figures of a run that was made before; none where the file is not whole.
std::optional<std::vector<double>> kept_figures(const std::filesystem::path& file,
                                                std::size_t count) {
  std::ifstream in{file};
  if (!in) return {};
  const auto json = nlohmann::json::parse(in, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("figures") || !json["figures"].is_array()) return {};
  std::vector<double> figures;
  for (const auto& value : json["figures"]) {
    if (!value.is_number()) return {};
    figures.push_back(value.get<double>());
  }
  if (figures.size() != count) return {};
  return figures;
}

}  // namespace

EnergyPlusEngine::EnergyPlusEngine(EngineSetup setup, const metering::LocalCalendar& calendar,
                                   std::string fingerprint)
    : setup_{std::move(setup)}, calendar_{calendar}, fingerprint_{std::move(fingerprint)} {}

Result<std::unique_ptr<EnergyPlusEngine>> EnergyPlusEngine::make(
    EngineSetup setup, const metering::LocalCalendar& calendar) {
  system::Sha256 digest;
  digest.add(setup.model.objects.dump());
  digest.add(setup.program.version);
  for (const ModelOutput& output : setup.outputs) {
    digest.add(output.is_peak ? "peak" : "mean");
    for (const SignedMeter& meter : output.meters) {
      digest.add(fmt::format("{}{}", meter.sign, meter.name));
    }
  }
  for (const TargetedParameter& one : setup.parameters) {
    digest.add(fmt::format("{}", static_cast<int>(one.change)));
    for (const Target& target : one.targets) digest.add(target.pattern);
  }
  std::set<int> years;
  for (const metering::Month month : setup.months) {
    digest.add(metering::to_string(month));
    years.insert(year_of(month));
  }
  digest.add(fmt::format("{} {}", setup.peak_window.count(), calendar.zone_name()));
  for (const int year : years) {
    const auto weather = setup.weather.find(year);
    if (weather == setup.weather.end()) {
      return failure(
          ErrorCode::invalid_value,
          fmt::format("there is no weather for {}, which has months of the model", year));
    }
    if (auto added = digest.add_file(weather->second); !added) {
      return tl::unexpected(added.error());
    }
  }
  return std::unique_ptr<EnergyPlusEngine>{
      new EnergyPlusEngine{std::move(setup), calendar, digest.hex()}};
}

std::string EnergyPlusEngine::key_of(const Eigen::VectorXd& values) const {
  system::Sha256 digest;
  digest.add(fingerprint_);
  for (const double value : values) digest.add(fmt::format("{:a} ", value));
  return digest.hex().substr(0, kKeyDigits);
}

Result<std::vector<double>> EnergyPlusEngine::run_year(
    const Json& objects, int year, const std::filesystem::path& folder,
    const std::function<bool()>& keep_going) const {
  const auto [first, last] = days_to_run(setup_.months, year);
  Json prepared = objects;
  const std::vector<std::string> names = meters_of(setup_.outputs);
  prepare_objects({.first = first, .last = last, .meters = names}, prepared);
  const auto sql = simulate(prepared, setup_.weather.at(year), folder, setup_.program,
                            setup_.limits, keep_going);
  if (!sql) return tl::unexpected(sql.error());
  const auto meters = read_meters(*sql, names, calendar_.standard_offset(std::chrono::year{year}));
  if (!meters) return tl::unexpected(meters.error());
  return monthly_figures(*meters, setup_.outputs, setup_.months, calendar_, setup_.peak_window);
}

Result<std::vector<double>> EnergyPlusEngine::run_row(
    const Eigen::VectorXd& values, const std::function<bool()>& keep_going) const {
  const std::size_t count = setup_.outputs.size() * setup_.months.size();
  const std::string key = key_of(values);
  const std::filesystem::path kept = setup_.folder / (key + ".json");
  if (auto figures = kept_figures(kept, count)) return std::move(*figures);

  Json objects = setup_.model.objects;
  for (std::size_t j = 0; j < setup_.parameters.size(); ++j) {
    const TargetedParameter& one = setup_.parameters[j];
    for (const Target& target : one.targets) {
      apply(target, one.change, values[static_cast<Eigen::Index>(j)], objects);
    }
  }
  const std::filesystem::path folder = setup_.folder / key;
  std::vector<double> figures(count, kAbsent);
  for (const auto& [year, weather] : setup_.weather) {
    const bool has_months = std::ranges::any_of(
        setup_.months, [&](metering::Month month) { return year_of(month) == year; });
    if (!has_months) continue;
    const auto of_year = run_year(objects, year, folder, keep_going);
    if (!of_year) return of_year;
    for (std::size_t i = 0; i < count; ++i) {
      if (!std::isnan((*of_year)[i])) figures[i] = (*of_year)[i];
    }
  }
  if (std::ranges::any_of(figures, [](double figure) { return !std::isfinite(figure); })) {
    return failure(ErrorCode::not_finite, "EnergyPlus did not report all of a month");
  }
  if (auto written = system::write_file(kept, nlohmann::json{{"figures", figures}}.dump());
      !written) {
    return tl::unexpected(written.error());
  }
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  return figures;
}

Result<Eigen::MatrixXd> EnergyPlusEngine::run(const Eigen::MatrixXd& theta,
                                              const ForEachIndex& executor,
                                              const Observer& observer) {
  assert(theta.cols() == static_cast<Eigen::Index>(setup_.parameters.size()));
  if (auto made = system::make_folder(setup_.folder); !made) return tl::unexpected(made.error());
  const auto rows = static_cast<std::size_t>(theta.rows());
  std::vector<Result<std::vector<double>>> results(rows, std::vector<double>{});
  std::atomic<int> done = 0;
  std::atomic<bool> is_stopped = false;
  std::mutex telling;
  const auto keep_going = [&] {
    if (is_stopped) return false;
    if (!observer) return true;
    const std::scoped_lock lock{telling};
    if (!observer(done, static_cast<int>(rows))) is_stopped = true;
    return !is_stopped.load();
  };
  executor(rows, [&](std::size_t row) {
    if (!keep_going()) {
      results[row] = failure(ErrorCode::cancelled, "stopped");
      return;
    }
    results[row] = run_row(theta.row(static_cast<Eigen::Index>(row)), keep_going);
    ++done;
  });

  const auto columns = static_cast<Eigen::Index>(setup_.outputs.size() * setup_.months.size());
  Eigen::MatrixXd outputs = Eigen::MatrixXd::Constant(theta.rows(), columns, kAbsent);
  std::vector<Parameter> parameters;
  for (const TargetedParameter& one : setup_.parameters) parameters.push_back(one.parameter);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto index = static_cast<Eigen::Index>(row);
    if (results[row]) {
      outputs.row(index) = Eigen::Map<const Eigen::RowVectorXd>(results[row]->data(), columns);
      continue;
    }
    const Error& error = results[row].error();
    if (error.code == ErrorCode::cancelled) return tl::unexpected(error);
    const std::vector<double> values{theta.row(index).begin(), theta.row(index).end()};
    failures_.push_back({describe(parameters, values), error.message});
  }
  return outputs;
}

}  // namespace recald::energyplus
