#include "tests/blind/running/run_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include "adapters/system/child_process.hpp"
#include "adapters/system/scratch_folder.hpp"
#include "tests/blind/running/calibration_line.hpp"
#include "tests/blind/running/diagnosis_line.hpp"
#include "tests/blind/running/drift_line.hpp"
#include "tests/blind/scoring/answers.hpp"
#include "tests/blind/scoring/calibration_scores.hpp"
#include "tests/blind/scoring/case_range.hpp"
#include "tests/blind/scoring/drift_scores.hpp"
#include "tests/blind/scoring/files.hpp"
#include "tests/blind/scoring/gap_scores.hpp"
#include "tests/blind/scoring/result_log.hpp"

namespace recald::blind {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSeed = "1";
constexpr int kExitUsage = 2;  // of recald, as of all its commands

// Effects that change what one meter shows; the diagnosis is told which.
constexpr std::array<std::string_view, 4> kOfOneMeter{"clock_offset", "phase_lost", "scale_fault",
                                                      "stuck_meter"};

/// What the oracle tells the diagnosis of one case.
struct Assumed {
  std::vector<std::string> effects;    ///< Ids.
  std::vector<std::string> arguments;  ///< EFFECT or EFFECT:METER
};

using CaseAssumptions = std::map<std::string, Assumed>;

std::string argument_of(const HiddenEffect& effect) {
  if (std::ranges::find(kOfOneMeter, effect.effect) == kOfOneMeter.end()) return effect.effect;
  Answer alone;
  alone.effects = {effect};
  return effect.effect + ":" + most_affected_meter(alone);
}

/// Cases that hide something of the catalogue.
Result<CaseAssumptions> assumptions_from(const fs::path& answers) {
  const auto key = read_answers(answers);
  if (!key) return tl::unexpected(key.error());
  CaseAssumptions all;
  for (const auto& [case_id, answer] : *key) {
    for (const HiddenEffect& effect : answer.effects) {
      if (!effect.in_catalogue) continue;
      all[case_id].effects.push_back(effect.effect);
      all[case_id].arguments.push_back(argument_of(effect));
    }
  }
  return all;
}

/// The last line that says anything.
std::string last_words(const fs::path& said) {
  const auto text = read_file(said);
  if (!text) return "";
  const std::size_t end = text->find_last_not_of(" \r\n");
  if (end == std::string::npos) return "";
  const std::size_t begin = text->find_last_of("\r\n", end);
  return text->substr(begin == std::string::npos ? 0 : begin + 1, end - begin);
}

/// Why there is no diagnosis; empty where there is one.
std::string failure_of(const system::ChildEnd& end, double limit_s, const fs::path& said) {
  switch (end.ending) {
    case system::Ending::over_limit:
      return fmt::format("no diagnosis within {:g} s", limit_s);
    case system::Ending::killed:
      return fmt::format("ended by signal {}", end.signal);
    case system::Ending::exited:
      if (end.exit_code == 0) return "";
      return fmt::format("exit code {}: {}", end.exit_code, last_words(said));
    case system::Ending::stopped:
      break;
  }
  return "stopped";
}

class Runner {
 public:
  Runner(const RunRequest& request, fs::path population, CaseAssumptions assumed,
         const std::atomic<bool>& stop, const RunObserver& observer)
      : request_(request),
        population_(std::move(population)),
        assumed_(std::move(assumed)),
        stop_(stop),
        observer_(observer) {}

  Result<RunSummary> run() {
    if (auto listed = list_cases(); !listed) return tl::unexpected(listed.error());
    auto scratch = system::ScratchFolder::make();
    if (!scratch) return tl::unexpected(scratch.error());
    scratch_.emplace(std::move(*scratch));
    if (auto asked = ask_version(); !asked) return tl::unexpected(asked.error());
    const std::size_t threads = std::min<std::size_t>(request_.jobs, open_.size());
    {
      std::vector<std::jthread> workers;
      for (std::size_t i = 0; i < threads; ++i) workers.emplace_back([this] { work(); });
    }
    if (error_) return tl::unexpected(*error_);
    summary_.stopped = stop_ && summary_.done < open_.size();
    return summary_;
  }

 private:
  [[nodiscard]] bool is_oracle() const { return request_.method == kOracle; }
  [[nodiscard]] bool is_calibration() const { return request_.method == kCalibrate; }
  [[nodiscard]] bool is_drift() const { return request_.method == kDrift; }
  [[nodiscard]] const char* written() const {
    return is_calibration() ? "calibration.json" : is_drift() ? "drift.json" : "diagnosis.json";
  }

  /// Those of the range without a line.
  Result<void> list_cases() {
    auto all = cases_in(population_);
    if (!all) return tl::unexpected(all.error());
    const auto range = case_range_of(request_.cases, all->size());
    if (!range) {
      return failure(ErrorCode::invalid_value,
                     fmt::format("--cases {}: give one number or two with a dash, 1 to {}",
                                 request_.cases, all->size()));
    }
    auto pending = pending_cases(population_, request_.results, request_.method);
    if (!pending) return tl::unexpected(pending.error());
    summary_.torn = std::move(pending->torn);
    for (std::size_t i = range->first - 1; i < range->last; ++i) {
      std::string& name = (*all)[i];
      if (is_oracle() && !assumed_.contains(name)) continue;
      ++summary_.cases;
      if (std::ranges::binary_search(pending->cases, name)) open_.push_back(std::move(name));
    }
    summary_.found = summary_.cases - open_.size();
    return {};
  }

  /// Also of the cases that fail: the scorer counts versions.
  Result<void> ask_version() {
    const fs::path said = scratch_->path() / "version.txt";
    const auto end = run_program({"--version"}, said);
    if (!end) return tl::unexpected(end.error());
    version_ = "recald " + last_words(said);
    return {};
  }

  void work() {
    for (std::size_t i = next_++; i < open_.size() && !stop_ && !ended_; i = next_++) {
      const auto done = diagnose(open_[i]);
      if (done) continue;
      const std::lock_guard lock(mutex_);
      ended_ = true;
      if (!error_) error_ = Error{done.error().code, open_[i] + ": " + done.error().message};
    }
  }

  Result<void> diagnose(const std::string& case_id) {
    const fs::path folder = scratch_->path() / case_id;
    std::error_code error;
    fs::create_directory(folder, error);
    const fs::path said = folder / "said.txt";
    const auto end = run_program(arguments_of(case_id, folder), said);
    if (!end) return tl::unexpected(end.error());
    if (end->ending == system::Ending::stopped) return {};
    if (end->ending == system::Ending::exited && end->exit_code == kExitUsage) {
      return failure(ErrorCode::unsupported, "the program refuses its arguments: " +
                                                 read_file(said).value_or(std::string()));
    }
    const auto noted = note(case_id, *end, folder);
    fs::remove_all(folder, error);
    return noted;
  }

  [[nodiscard]] Result<system::ChildEnd> run_program(std::vector<std::string> arguments,
                                                     const fs::path& said) const {
    return system::run_child({.program = request_.program,
                              .arguments = std::move(arguments),
                              .output = said,
                              .time_max = std::chrono::duration<double>{request_.limit_s}},
                             [this] { return !stop_; });
  }

  [[nodiscard]] std::vector<std::string> arguments_of(const std::string& case_id,
                                                      const fs::path& folder) const {
    std::vector<std::string> arguments{
        is_calibration() || is_drift() ? request_.method : "diagnose",
        (population_ / case_id / "site.toml").string(),
        "--out",
        folder.string(),
        "--seed",
        kSeed};
    if (is_drift()) arguments.insert(arguments.end(), {"--threads", "1"});
    if (!is_oracle()) return arguments;
    for (const std::string& assumed : assumed_.at(case_id).arguments) {
      arguments.insert(arguments.end(), {"--assume", assumed});
    }
    return arguments;
  }

  Result<void> note(const std::string& case_id, const system::ChildEnd& end,
                    const fs::path& folder) {
    const CaseRun run{case_id, request_.method, end.wall_s, end.cpu_s, end.peak_rss_MB, version_};
    std::string why = failure_of(end, request_.limit_s, folder / "said.txt");
    const auto diagnosis =
        why.empty() ? read_written(folder) : Result<Json>(failure(ErrorCode::not_found, why));
    if (diagnosis) {
      if (auto kept = keep(case_id, folder); !kept) return kept;
    }
    const auto line =
        diagnosis ? line_of(*diagnosis, run) : Result<Json>(tl::unexpected(diagnosis.error()));
    if (!line) why = line.error().message;
    const std::lock_guard lock(mutex_);
    if (const auto noted = append(line ? *line : failure_line(run, why)); !noted) return noted;
    ++summary_.done;
    if (!line) ++summary_.failed;
    if (end.ending == system::Ending::over_limit) ++summary_.over_limit;
    if (observer_) observer_(summary_.done, open_.size(), summary_.failed);
    return {};
  }

  [[nodiscard]] Result<Json> read_written(const fs::path& folder) const {
    const auto text = read_file(folder / written());
    if (!text) {
      return failure(ErrorCode::not_found, fmt::format("exit code 0, but no {}", written()));
    }
    Json json = Json::parse(*text, nullptr, /*allow_exceptions=*/false);
    if (json.is_discarded()) {
      return failure(ErrorCode::malformed, fmt::format("{} is no JSON", written()));
    }
    return json;
  }

  [[nodiscard]] Result<void> keep(const std::string& case_id, const fs::path& folder) const {
    if (request_.keep.empty()) return {};
    std::error_code error;
    fs::copy_file(folder / written(), request_.keep / (case_id + ".json"),
                  fs::copy_options::overwrite_existing, error);
    if (!error) return {};
    return failure(ErrorCode::io_failed, "what it wrote cannot be kept: " + error.message());
  }

  [[nodiscard]] Result<Json> line_of(const Json& diagnosis, const CaseRun& run) const {
    if (is_calibration()) return calibration_line(diagnosis, run);
    if (is_drift()) return drift_line(diagnosis, run);
    return is_oracle() ? oracle_line(diagnosis, run, assumed_.at(run.case_id).effects)
                       : diagnosis_line(diagnosis, run);
  }

  [[nodiscard]] Result<void> append(const Json& line) const {
    return append_result(request_.results,
                         line.dump(-1, ' ', false, Json::error_handler_t::replace), Reruns::refuse);
  }

  const RunRequest& request_;
  fs::path population_;
  CaseAssumptions assumed_;
  const std::atomic<bool>& stop_;
  const RunObserver& observer_;
  std::optional<system::ScratchFolder> scratch_;
  std::string version_;
  std::vector<std::string> open_;  // cases without a line
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> ended_ = false;  // by an error
  std::mutex mutex_;                 // of what stands below
  RunSummary summary_;
  std::optional<Error> error_;
};

/// What would only show after the first diagnosis, or after the last.
std::optional<Error> misuse_of(const RunRequest& request) {
  const bool oracle = request.method == kOracle;
  std::string what;
  if (oracle == request.answers.empty()) {
    what = oracle ? "method oracle needs --answers" : "--answers is for method oracle alone";
  }
  if (what.empty()) return std::nullopt;
  return Error{ErrorCode::invalid_value, what};
}

}  // namespace

Result<RunSummary> run_cases(const RunRequest& request, const std::atomic<bool>& stop,
                             const RunObserver& observer) {
  if (auto misuse = misuse_of(request)) return tl::unexpected(std::move(*misuse));
  CaseAssumptions assumed;
  if (request.method == kOracle) {
    auto read = assumptions_from(request.answers);
    if (!read) return tl::unexpected(read.error());
    assumed = std::move(*read);
  }
  if (!request.keep.empty()) {
    std::error_code error;
    fs::create_directories(request.keep, error);
    if (error) {
      return failure(ErrorCode::io_failed,
                     "cannot make '" + request.keep.string() + "': " + error.message());
    }
  }
  const fs::path inner = request.population / "cases";
  return Runner(request, fs::is_directory(inner) ? inner : request.population, std::move(assumed),
                stop, observer)
      .run();
}

}  // namespace recald::blind
