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

#include "adapters/energyplus/known_parameters.hpp"
#include "adapters/energyplus/run/meter_output.hpp"
#include "adapters/system/files/sha256.hpp"
#include "adapters/system/files/write_file.hpp"
#include "core/absent.hpp"
#include "core/weather/daily_inputs.hpp"

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

std::optional<std::vector<double>> numbers_in(const Json& json, const char* key,
                                              std::size_t count) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_array() || found->size() != count) return {};
  std::vector<double> numbers;
  numbers.reserve(count);
  for (const auto& value : *found) {
    if (!value.is_number()) return {};
    numbers.push_back(value.get<double>());
  }
  return numbers;
}

/// The figures of a run that was made before; none where the file is not whole.
std::optional<RunFigures> kept_figures(const std::filesystem::path& file, std::size_t months,
                                       std::size_t days) {
  std::ifstream in{file};
  if (!in) return {};
  const auto json = Json::parse(in, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return {};
  auto of_months = numbers_in(json, "figures", months);
  auto of_days = numbers_in(json, "days", days);
  if (!of_months || !of_days) return {};
  return RunFigures{std::move(*of_months), std::move(*of_days)};
}

/// Of days six digits are kept: there are many, and they are summed.
std::string kept_text(const RunFigures& figures) {
  const auto digits = [](double value) { return fmt::format("{:.6g}", value); };
  std::vector<std::string> days(figures.days.size());
  std::ranges::transform(figures.days, days.begin(), digits);
  return fmt::format(R"({{"figures":{},"days":[{}]}})", Json(figures.months).dump(),
                     fmt::join(days, ","));
}

/// Takes over what `from` has and `to` lacks.
void fill_in(const std::vector<double>& from, std::vector<double>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (!std::isnan(from[i])) to[i] = from[i];
  }
}

std::string effect_text(const ModelEffect& effect) {
  const auto day = [](const std::optional<Day>& one) {
    return one ? metering::to_string(*one) : std::string{"-"};
  };
  return fmt::format("{} {} {}", effect.patch.effect, day(effect.from), day(effect.to));
}

/// Whether the effect is there on a day.
bool is_there(const ModelEffect& effect, Day day) {
  return (!effect.from || *effect.from <= day) && (!effect.to || day < *effect.to);
}

/// The first days of the year on which an effect comes or goes, after its first day.
std::set<Day> changes_in(const std::vector<TargetedParameter>& parameters, int year) {
  std::set<Day> changes;
  for (const TargetedParameter& one : parameters) {
    if (!one.effect) continue;
    for (const std::optional<Day>& day : {one.effect->from, one.effect->to}) {
      const bool is_within =
          day && static_cast<int>(day->year()) == year && *day != std::chrono::year{year} / 1 / 1;
      if (is_within) changes.insert(*day);
    }
  }
  return changes;
}

/// From an instant on, what another run of the same days gives.
void continue_with(const std::vector<MeterOutput>& other, metering::Instant from,
                   std::vector<MeterOutput>& meters) {
  for (std::size_t i = 0; i < meters.size(); ++i) {
    for (std::size_t j = 0; j < meters[i].starts.size(); ++j) {
      if (meters[i].starts[j] >= from) meters[i].energy_kWh[j] = other[i].energy_kWh[j];
    }
  }
}

bool are_whole(const std::vector<double>& figures) {
  return std::ranges::all_of(figures, [](double figure) { return std::isfinite(figure); });
}

}  // namespace

EnergyPlusEngine::EnergyPlusEngine(EngineSetup setup, const metering::LocalCalendar& calendar,
                                   std::string fingerprint)
    : setup_{std::move(setup)}, calendar_{calendar}, fingerprint_{std::move(fingerprint)} {
  days_ = weather::days_of(setup_.months);
}

Result<std::unique_ptr<EnergyPlusEngine>> EnergyPlusEngine::make(
    EngineSetup setup, const metering::LocalCalendar& calendar) {
  system::Sha256 digest;
  digest.add(setup.model.objects.dump());
  digest.add(setup.program.version);
  for (const ModelOutput& output : setup.outputs) {
    digest.add(output.is_peak ? fmt::format("peak {}", output.interval_noise) : "mean");
    for (const SignedMeter& meter : output.meters) {
      digest.add(fmt::format("{}{}", meter.sign, meter.name));
    }
  }
  for (const TargetedParameter& one : setup.parameters) {
    digest.add(fmt::format("{} {:a}", static_cast<int>(one.change), one.design));
    if (one.effect) digest.add(effect_text(*one.effect));
    for (const Target& target : one.targets) {
      digest.add(fmt::format("{} {}", static_cast<int>(target.sense), target.most));
      for (const auto& field : target.fields) digest.add(field.to_string());
    }
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
    TRY(digest.add_file(weather->second));
  }
  return std::unique_ptr<EnergyPlusEngine>{
      new EnergyPlusEngine{std::move(setup), calendar, digest.hex()}};
}

std::vector<Parameter> EnergyPlusEngine::parameters() const {
  std::vector<Parameter> parameters;
  for (const TargetedParameter& one : setup_.parameters) parameters.push_back(one.parameter);
  return parameters;
}

std::string EnergyPlusEngine::key_of(const Eigen::VectorXd& values) const {
  system::Sha256 digest;
  digest.add(fingerprint_);
  for (const double value : values) digest.add(fmt::format("{:a} ", value));
  return digest.hex().substr(0, kKeyDigits);
}

Result<std::vector<MeterOutput>> EnergyPlusEngine::simulate_year(
    const Json& objects, int year, const std::filesystem::path& folder,
    const std::function<bool()>& keep_going) const {
  const auto [first, last] = days_to_run(setup_.months, year);
  Json prepared = objects;
  const std::vector<std::string> names = meters_of(setup_.outputs);
  prepare_objects({.first = first, .last = last, .meters = names}, prepared);
  const auto sql = TRY(simulate(prepared, setup_.weather.at(year), folder, setup_.program,
                                setup_.limits, keep_going));
  return read_meters(sql, names, calendar_.standard_offset(std::chrono::year{year}));
}

Result<RunFigures> EnergyPlusEngine::run_year(const Eigen::VectorXd& values, int year,
                                              const std::filesystem::path& folder,
                                              const std::function<bool()>& keep_going) const {
  const Day new_year = std::chrono::year{year} / 1 / 1;
  auto meters = TRY(simulate_year(objects_at(values, new_year), year, folder, keep_going));
  for (const Day day : changes_in(setup_.parameters, year)) {
    const auto since = TRY(simulate_year(objects_at(values, day), year, folder, keep_going));
    continue_with(since, calendar_.day_span(day).begin, meters);
  }
  return RunFigures{
      monthly_figures(meters, setup_.outputs, setup_.months, calendar_, setup_.peak_window),
      daily_figures(meters, setup_.outputs, days_, calendar_, setup_.peak_window)};
}

Json EnergyPlusEngine::objects_at(const Eigen::VectorXd& values, Day day) const {
  Json objects = setup_.model.objects;
  for (std::size_t j = 0; j < setup_.parameters.size(); ++j) {
    const TargetedParameter& one = setup_.parameters[j];
    const auto row = static_cast<Eigen::Index>(j);
    for (const Target& target : one.targets) {
      apply(target, one.change, one.amount(values[row]), objects);
    }
  }
  // A patch copies schedules, so what parameters and measures change in them comes first.
  for (std::size_t j = 0; j < setup_.parameters.size(); ++j) {
    const TargetedParameter& one = setup_.parameters[j];
    const auto row = static_cast<Eigen::Index>(j);
    const bool is_first = j == 0 || setup_.parameters[j - 1].effect != one.effect;
    if (!one.effect || !is_first || !is_there(*one.effect, day)) continue;
    one.effect->patch.apply({values.data() + row, one.effect->values}, objects);
  }
  settle(setup_.model.objects, objects);
  return objects;
}

Result<RunFigures> EnergyPlusEngine::run_row(const Eigen::VectorXd& values,
                                             const std::function<bool()>& keep_going) const {
  const std::size_t month_count = setup_.outputs.size() * setup_.months.size();
  const std::size_t day_count = setup_.outputs.size() * days_.size();
  const std::string key = key_of(values);
  const std::filesystem::path kept = setup_.folder / (key + ".json");
  if (auto figures = kept_figures(kept, month_count, day_count)) return std::move(*figures);

  const std::filesystem::path folder = setup_.folder / key;
  RunFigures figures{std::vector<double>(month_count, kAbsent),
                     std::vector<double>(day_count, kAbsent)};
  for (const auto& [year, weather] : setup_.weather) {
    const bool has_months = std::ranges::any_of(
        setup_.months, [&](metering::Month month) { return year_of(month) == year; });
    if (!has_months) continue;
    const auto of_year = run_year(values, year, folder, keep_going);
    if (!of_year) return of_year;
    fill_in(of_year->months, figures.months);
    fill_in(of_year->days, figures.days);
  }
  if (!are_whole(figures.months) || !are_whole(figures.days)) {
    return failure(ErrorCode::not_finite, "EnergyPlus did not report all of a month");
  }
  TRY(system::write_file(kept, kept_text(figures)));
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  return figures;
}

Result<Eigen::MatrixXd> EnergyPlusEngine::run(const Eigen::MatrixXd& theta,
                                              const ForEachIndex& executor,
                                              const Observer& observer) {
  assert(theta.cols() == static_cast<Eigen::Index>(setup_.parameters.size()));
  TRY(system::make_folder(setup_.folder));
  const auto rows = static_cast<std::size_t>(theta.rows());
  std::vector<Result<RunFigures>> results(rows, RunFigures{});
  std::atomic<int> done = 0;
  std::atomic<bool> is_stopped = false;
  std::mutex reporting;
  const auto keep_going = [&] {
    if (is_stopped) return false;
    if (!observer) return true;
    const std::scoped_lock lock{reporting};
    if (!observer(done, static_cast<int>(rows))) is_stopped = true;
    return !is_stopped.load();
  };
  // Equal rows are one run: each has a folder of its own, named after its values.
  std::vector<std::size_t> run_of(rows);
  std::map<std::string, std::size_t> first_of;
  for (std::size_t row = 0; row < rows; ++row) {
    run_of[row] =
        first_of.try_emplace(key_of(theta.row(static_cast<Eigen::Index>(row))), row).first->second;
  }
  executor(rows, [&](std::size_t row) {
    if (run_of[row] != row) return;
    if (!keep_going()) {
      results[row] = failure(ErrorCode::cancelled, "stopped");
      return;
    }
    results[row] = run_row(theta.row(static_cast<Eigen::Index>(row)), keep_going);
    ++done;
  });

  const auto columns = static_cast<Eigen::Index>(setup_.outputs.size() * setup_.months.size());
  Eigen::MatrixXd outputs = Eigen::MatrixXd::Constant(theta.rows(), columns, kAbsent);
  failures_.clear();
  const auto day_columns = static_cast<Eigen::Index>(setup_.outputs.size() * days_.size());
  daily_.setConstant(theta.rows(), day_columns, kAbsent);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto index = static_cast<Eigen::Index>(row);
    const Result<RunFigures>& result = results[run_of[row]];
    if (result) {
      outputs.row(index) = Eigen::Map<const Eigen::RowVectorXd>(result->months.data(), columns);
      daily_.row(index) = Eigen::Map<const Eigen::RowVectorXd>(result->days.data(), day_columns);
      continue;
    }
    const Error& error = result.error();
    // A full disk is no fault of the run's parameters.
    const bool stops_all = error.code == ErrorCode::cancelled || error.code == ErrorCode::io_failed;
    if (stops_all) return tl::unexpected(error);
    failures_.push_back({index, error.message});
  }
  return outputs;
}

}  // namespace recald::energyplus
