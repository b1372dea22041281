#include "tests/blind/energyplus/engine.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <set>

#include "adapters/system/child_process.hpp"
#include "adapters/system/files/write_file.hpp"

namespace recald::blind {
namespace {

namespace fs = std::filesystem;

constexpr double kJoulePerKilowattHour = 3.6e6;
constexpr std::size_t kQuartersPerHour = 4;

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
struct CloseStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

/// A query of a finished run, row by row.
class Rows {
 public:
  Rows(const fs::path& sql, const char* query) {
    sqlite3* opened = nullptr;
    const bool is_open =
        sqlite3_open_v2(sql.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr) == SQLITE_OK;
    database_.reset(opened);
    sqlite3_stmt* prepared = nullptr;
    if (is_open) sqlite3_prepare_v2(opened, query, -1, &prepared, nullptr);
    statement_.reset(prepared);
  }
  [[nodiscard]] bool is_open() const { return statement_ != nullptr; }
  bool next() { return sqlite3_step(statement_.get()) == SQLITE_ROW; }
  [[nodiscard]] std::string text(int column) const {
    const auto* const value = sqlite3_column_text(statement_.get(), column);
    return value == nullptr ? "" : reinterpret_cast<const char*>(value);
  }
  [[nodiscard]] double number(int column) const {
    return sqlite3_column_double(statement_.get(), column);
  }
  [[nodiscard]] int whole(int column) const { return sqlite3_column_int(statement_.get(), column); }

 private:
  std::unique_ptr<sqlite3, CloseDatabase> database_;
  std::unique_ptr<sqlite3_stmt, CloseStatement> statement_;
};

tl::unexpected<Error> refused(const fs::path& folder, std::string_view what,
                              const std::string& said) {
  return failure(ErrorCode::invalid_value,
                 fmt::format("{} in {}: {}", what, folder.string(), said));
}

tl::unexpected<Error> unreadable(const fs::path& folder, const char* what) {
  return failure(ErrorCode::io_failed,
                 fmt::format("EnergyPlus in {} left {}", folder.string(), what));
}

/// The first lines of a log that tell of an error.
std::string errors_of(const fs::path& log) {
  std::ifstream file(log);
  std::string said;
  int lines = 0;
  for (std::string line; lines < 6 && std::getline(file, line);) {
    const bool tells = line.find("Severe") != std::string::npos ||
                       line.find("Fatal") != std::string::npos ||
                       line.find("rror") != std::string::npos;
    if (!tells) continue;
    said += line + "; ";
    ++lines;
  }
  return said;
}

Result<Json> read_json(const fs::path& file) {
  std::ifstream stream(file);
  Json json = Json::parse(stream, nullptr, false);
  if (json.is_discarded()) {
    return failure(ErrorCode::io_failed, fmt::format("cannot read {}", file.string()));
  }
  return json;
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Words in lower case, without those that say nothing.
std::set<std::string> words_of(const std::string& text) {
  static const std::set<std::string> kSilent{
      "design", "size", "user",    "specified", "initial",   "rate",   "during",
      "of",     "at",   "when",    "is",        "operation", "needed", "or",
      "steam",  "no",   "nominal", "hot",       "rated",     "value"};
  std::set<std::string> words;
  std::string word;
  for (const char c : text + " ") {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      continue;
    }
    if (!word.empty() && !kSilent.contains(word)) words.insert(word);
    word.clear();
  }
  return words;
}

struct Size {
  std::set<std::string> words;
  double value;
};

/// Whether one tells of one thing and the other of its opposite.
bool contradict(const std::set<std::string>& a, const std::set<std::string>& b) {
  for (const auto& [one, other] : {std::pair{"minimum", "maximum"}, std::pair{"heating", "cooling"},
                                   std::pair{"high", "low"}, std::pair{"sensible", "total"}}) {
    if ((a.contains(one) && b.contains(other)) || (a.contains(other) && b.contains(one))) {
      return true;
    }
  }
  return false;
}

/// How much two sets of words are alike, 0 to 1.
double likeness(const std::set<std::string>& a, const std::set<std::string>& b) {
  if (contradict(a, b)) return 0.0;
  std::size_t common = 0;
  for (const std::string& word : a) common += b.count(word);
  const std::size_t all = a.size() + b.size() - common;
  return all == 0 ? 0.0 : static_cast<double>(common) / static_cast<double>(all);
}

bool is_open_size(const Json& value) {
  if (!value.is_string()) return false;
  const std::string text = simulators::energyplus::in_capitals(value.get<std::string>());
  return text == "AUTOSIZE" || text == "AUTOCALCULATE";
}

}  // namespace

Result<Engine> Engine::find() {
  const char* const named = std::getenv("RECALD_ENERGYPLUS");
  const fs::path program = named == nullptr ? "" : named;
  std::error_code ignored;
  if (program.empty() || !fs::is_regular_file(program, ignored)) {
    return failure(ErrorCode::not_found, "RECALD_ENERGYPLUS names no EnergyPlus");
  }
  const fs::path payload = fs::absolute(program).parent_path();
  for (const char* each : {"energyplus", "ConvertInputFormat", "ExpandObjects"}) {
    // The Python package leaves them without the right to be run.
    fs::permissions(payload / each, fs::perms::owner_exec, fs::perm_options::add, ignored);
  }
  return Engine(payload);
}

Result<Json> Engine::expand(const Json& templated, const fs::path& folder) const {
  if (const auto made = system::make_folder(folder); !made) return tl::unexpected(made.error());
  auto written = system::write_file(folder / "in.epJSON", templated.dump());
  if (!written) return tl::unexpected(written.error());
  std::error_code ignored;
  fs::create_symlink(payload_ / "Energy+.idd", folder / "Energy+.idd", ignored);
  const auto step = [&](const char* program, std::vector<std::string> arguments) -> Result<void> {
    const auto ended = system::run_child({.program = payload_ / program,
                                          .arguments = std::move(arguments),
                                          .folder = folder,
                                          .output = folder / "expand.log"},
                                         {});
    if (!ended) return tl::unexpected(ended.error());
    if (ended->ending == system::Ending::exited && ended->exit_code == 0) return {};
    return refused(folder, program, errors_of(folder / "expand.log"));
  };
  auto done = step("ConvertInputFormat", {"in.epJSON"});
  if (done) done = step("ExpandObjects", {});
  if (!done) return tl::unexpected(done.error());
  fs::rename(folder / "expanded.idf", folder / "objects.idf", ignored);
  done = step("ConvertInputFormat", {"objects.idf"});
  if (!done) return tl::unexpected(done.error());
  auto model = read_json(folder / "objects.epJSON");
  if (!model) return refused(folder, "ExpandObjects", errors_of(folder / "expandedidf.err"));
  model->erase("Output:PreprocessorMessage");
  return model;
}

Result<void> Engine::simulate(const Json& model, const fs::path& weather,
                              const std::vector<std::string>& options,
                              const fs::path& folder) const {
  if (const auto made = system::make_folder(folder); !made) return made;
  auto written = system::write_file(folder / "model.epJSON", model.dump());
  if (!written) return written;
  std::vector<std::string> arguments{"--weather", weather.string()};
  arguments.insert(arguments.end(), options.begin(), options.end());
  arguments.emplace_back("model.epJSON");
  constexpr std::chrono::minutes kLongest{10};
  const auto ended = system::run_child({.program = payload_ / "energyplus",
                                        .arguments = arguments,
                                        .folder = folder,
                                        .output = folder / "run.log",
                                        .time_max = kLongest},
                                       {});
  if (!ended) return tl::unexpected(ended.error());
  if (ended->ending != system::Ending::exited) {
    return failure(
        ErrorCode::io_failed,
        fmt::format("EnergyPlus in {} was ended from outside or took more than {} minutes",
                    folder.string(), kLongest.count()));
  }
  if (ended->exit_code == 0) return {};
  return refused(folder, "EnergyPlus", errors_of(folder / "eplusout.err"));
}

Result<SizedModel> Engine::size(Json model, const fs::path& weather, const fs::path& folder) const {
  // Schedules are told step by step; they are read as quarter hours.
  model["Timestep"] = {{"Quarter hours", {{"number_of_timesteps_per_hour", kQuartersPerHour}}}};
  Json& control = model["SimulationControl"].front();
  control["run_simulation_for_sizing_periods"] = "Yes";
  control["run_simulation_for_weather_file_run_periods"] = "No";
  model["Output:SQLite"] = {{"Results", {{"option_type", "SimpleAndTabular"}}}};
  model["Output:Table:SummaryReports"] = {
      {"Reports", {{"reports", Json::array({{{"report_name", "AllSummary"}}})}}}};
  model["Output:Schedules"] = {{"Schedules", {{"key_field", "Timestep"}}}};
  if (const auto ran = simulate(model, weather, {"--design-day"}, folder); !ran) {
    return tl::unexpected(ran.error());
  }
  SizedModel sized{{}, {}, folder / "eplusout.eio"};
  Rows rows(folder / "eplusout.sql",
            "SELECT TableName, RowName, ColumnName, Value FROM TabularDataWithStrings");
  if (!rows.is_open()) return unreadable(folder, "no tables");
  while (rows.next()) {
    sized.tables[rows.text(0)][trimmed(rows.text(1))][trimmed(rows.text(2))] =
        trimmed(rows.text(3));
  }
  for (const char* only_here :
       {"Output:Table:SummaryReports", "Output:Schedules", "Output:SQLite"}) {
    model.erase(only_here);
  }
  auto closed = with_sizes(std::move(model), folder / "eplusout.sql");
  if (!closed) return tl::unexpected(closed.error());
  sized.model = std::move(*closed);
  return sized;
}

Result<std::vector<std::vector<double>>> Engine::run(Json model, int year, const fs::path& weather,
                                                     const std::vector<MeterSum>& meters,
                                                     const fs::path& folder) const {
  Json& control = model["SimulationControl"].front();
  control["run_simulation_for_sizing_periods"] = "No";
  control["run_simulation_for_weather_file_run_periods"] = "Yes";
  model["RunPeriod"] = {{"Year",
                         {{"begin_month", 1},
                          {"begin_day_of_month", 1},
                          {"begin_year", year},
                          {"end_month", 12},
                          {"end_day_of_month", 31},
                          {"end_year", year},
                          {"use_weather_file_daylight_saving_period", "Yes"},
                          {"use_weather_file_holidays_and_special_days", "Yes"}}}};
  std::vector<std::string> not_ours{"RunPeriodControl:DaylightSavingTime",
                                    "RunPeriodControl:SpecialDays"};
  for (const auto& [type, objects] : model.items()) {
    if (type.starts_with("Output:")) not_ours.push_back(type);
  }
  for (const std::string& type : not_ours) model.erase(type);
  std::set<std::string> reported;
  for (const MeterSum& meter : meters) {
    for (const std::string& name : meter.reported) reported.insert(name.substr(name[0] == '-'));
  }
  Json outputs = Json::object();
  for (const std::string& name : reported) {
    outputs[fmt::format("Meter {}", outputs.size() + 1)] = {{"key_name", name},
                                                            {"reporting_frequency", "Timestep"}};
  }
  model["Output:Meter"] = outputs;
  model["Output:SQLite"] = {{"Results", {{"option_type", "Simple"}}}};
  model["Timestep"] = {{"Quarter hours", {{"number_of_timesteps_per_hour", kQuartersPerHour}}}};
  if (const auto ran = simulate(model, weather, {}, folder); !ran)
    return tl::unexpected(ran.error());

  const std::chrono::sys_days first{std::chrono::year{year} / 1 / 1};
  const std::chrono::sys_days end{std::chrono::year{year + 1} / 1 / 1};
  const std::size_t quarters =
      static_cast<std::size_t>((end - first).count()) * 24 * kQuartersPerHour;
  std::map<std::string, std::vector<double>> kW;
  Rows rows(folder / "eplusout.sql",
            "SELECT m.Name, t.Month, t.Day, t.Hour, t.Minute, d.Value FROM ReportData d "
            "JOIN Time t ON t.TimeIndex = d.TimeIndex "
            "JOIN ReportDataDictionary m ON m.ReportDataDictionaryIndex = "
            "d.ReportDataDictionaryIndex "
            "WHERE m.IsMeter = 1 AND coalesce(t.WarmupFlag, 0) = 0");
  if (!rows.is_open()) return unreadable(folder, "no results");
  while (rows.next()) {
    std::vector<double>& of = kW[rows.text(0)];
    of.resize(quarters, std::nan(""));
    const std::chrono::sys_days day{std::chrono::year{year} / rows.whole(1) / rows.whole(2)};
    // Stamped at its end: 00:15 is the first of a day, 24:00 the last.
    const auto ended = static_cast<std::size_t>((day - first).count()) * 24 * kQuartersPerHour +
                       static_cast<std::size_t>(rows.whole(3)) * kQuartersPerHour +
                       static_cast<std::size_t>(rows.whole(4)) / 15;
    if (ended < 1 || ended > quarters)
      return refused(folder, "EnergyPlus", "an hour outside the year");
    of[ended - 1] = rows.number(5) / kJoulePerKilowattHour * kQuartersPerHour;
  }
  std::vector<std::vector<double>> sums;
  for (const MeterSum& meter : meters) {
    std::vector<double>& sum = sums.emplace_back(quarters, 0.0);
    for (const std::string& name : meter.reported) {
      const bool subtracts = name[0] == '-';
      const auto found = kW.find(name.substr(subtracts ? 1 : 0));
      if (found == kW.end()) return refused(folder, "EnergyPlus", "no meter " + name);
      for (std::size_t i = 0; i < quarters; ++i)
        sum[i] += (subtracts ? -1.0 : 1.0) * found->second[i];
    }
    if (std::ranges::any_of(sum, [](double value) { return !std::isfinite(value); })) {
      return failure(ErrorCode::malformed,
                     fmt::format("{}: {} lacks an interval", folder.string(), meter.id));
    }
  }
  return sums;
}

Result<Json> with_sizes(Json model, const fs::path& sql) {
  Rows rows(sql, "SELECT CompType, CompName, Description, Value FROM ComponentSizes");
  if (!rows.is_open()) {
    return failure(ErrorCode::io_failed, fmt::format("{} has no sizes", sql.string()));
  }
  using simulators::energyplus::in_capitals;
  std::map<std::pair<std::string, std::string>, std::vector<Size>> sizes;
  while (rows.next()) {
    sizes[{in_capitals(rows.text(0)), in_capitals(rows.text(1))}].push_back(
        {words_of(rows.text(2)), rows.number(3)});
  }
  constexpr double kAlike = 0.5;
  for (auto& [type, objects] : model.items()) {
    if (type.starts_with("Sizing:") || type.starts_with("CoolingTower:")) continue;
    for (auto& [name, object] : objects.items()) {
      const auto found = sizes.find({in_capitals(type), in_capitals(name)});
      if (found == sizes.end()) continue;
      for (auto& [field, value] : object.items()) {
        if (!is_open_size(value)) continue;
        const std::set<std::string> words = words_of(field);
        const Size* best = nullptr;
        double most = kAlike;
        for (const Size& size : found->second) {
          const double alike = likeness(words, size.words);
          // A zero may stand for "not sized", unless it is just this field's.
          if (alike < most || (size.value == 0.0 && alike < 1.0)) continue;
          most = alike;
          best = &size;
        }
        if (best == nullptr) continue;
        // EnergyPlus refuses the frost in which it sized the coil itself, zero included.
        value = field == "design_inlet_air_temperature" ? std::max(best->value, 0.1) : best->value;
      }
    }
  }
  return model;
}

}  // namespace recald::blind
