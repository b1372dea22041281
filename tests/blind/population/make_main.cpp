// Draws a blind population: cases as users would have them, answers apart and sealed.
//
//   blind_make --population sealed --seed N --out DIR [--cases 1-20] [--twins] [--threads 0]
//   blind_make --population plain --uses office,shop --count 60 --seed N --out DIR
//   blind_make --world energyplus --population development --seed N --out DIR

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <fstream>
#include <functional>
#include <iostream>
#include <mutex>

#include "adapters/system/files/write_file.hpp"
#include "adapters/system/parallel_for.hpp"
#include "tests/blind/energyplus/eplus_case.hpp"
#include "tests/blind/population/case_range.hpp"
#include "tests/blind/population/make_case.hpp"
#include "tests/blind/population/seal.hpp"

namespace {

using namespace recald;
using namespace recald::blind;

struct Arguments {
  std::string world = "own";
  std::string population;
  std::uint64_t seed = 1;
  std::filesystem::path out;
  std::string cases;
  std::vector<std::string> uses;  ///< Of a plain population; with `count`.
  std::size_t count = 0;
  bool twins = false;
  unsigned threads = 0;
};

int failed(const std::string& sentence, int code = 1) {
  std::cerr << "blind_make: " << sentence << '\n';
  return code;
}

/// One case to be made, whatever world it is of.
struct Task {
  std::string id;
  /// Writes case and answer. @param scratch  A folder that need not be there; nothing of it stays.
  /// @return how many simulations it took.
  std::function<Result<int>(const std::filesystem::path& scratch)> make;
};

/// Makes those that have no answer yet; a run that was stopped goes on where it was.
class Maker {
 public:
  Maker(const CaseFolders& folders, std::filesystem::path scratch, std::size_t total)
      : folders_(folders), scratch_(std::move(scratch)), total_(total) {}
  ~Maker() {
    std::error_code whatever;  // a folder that stays harms nothing, and may be another run's
    std::filesystem::remove(scratch_, whatever);
  }
  Maker(const Maker&) = delete;
  Maker& operator=(const Maker&) = delete;

  void make(const Task& task) {
    if (stopped_ || std::filesystem::exists(folders_.answers / (task.id + ".json"))) return;
    const std::filesystem::path own = scratch_ / task.id;
    const auto made = task.make(own);
    std::error_code whatever;
    std::filesystem::remove_all(own, whatever);
    if (made) forget_when(task.id);
    const std::lock_guard lock(mutex_);
    if (!made) {
      stopped_ = true;
      error_ = task.id + ": " + made.error().message;
      return;
    }
    // Neither block nor effect is said: whoever makes a sealed population must not learn it.
    std::cerr << fmt::format("\r{} of {} ({} simulations)   ", ++made_, total_,
                             simulations_ += *made);
  }

  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  /// How long a case took to make would tell whether something is hidden in it.
  void forget_when(const std::string& id) const {
    const std::filesystem::file_time_type never{};
    std::error_code whatever;  // Only the times would stay.
    for (const auto& file : std::filesystem::directory_iterator(folders_.cases / id, whatever)) {
      std::filesystem::last_write_time(file, never, whatever);
    }
    std::filesystem::last_write_time(folders_.cases / id, never, whatever);
    std::filesystem::last_write_time(folders_.answers / (id + ".json"), never, whatever);
  }

  const CaseFolders& folders_;
  std::filesystem::path scratch_;
  std::size_t total_;
  std::mutex mutex_;
  std::atomic<bool> stopped_ = false;
  std::size_t made_ = 0;
  int simulations_ = 0;
  std::string error_;
};

/// What is asked for, in words and as work.
struct Population {
  std::string name;
  std::vector<Task> tasks;
};

Result<Population> of_own_world(std::string name, const std::vector<CasePlan>& plans,
                                const CaseFolders& folders) {
  Population population{std::move(name), {}};
  for (const CasePlan& plan : plans) {
    population.tasks.push_back(
        {plan.id, [plan, folders](const std::filesystem::path& /*scratch*/) -> Result<int> {
           const auto settled = settle(plan);
           if (!settled) return tl::unexpected(settled.error());
           const auto written = write_case(plan, *settled, folders);
           if (!written) return tl::unexpected(written.error());
           return settled->simulations + 1;
         }});
  }
  return population;
}

Result<Population> of_energyplus(const Arguments& given, const CaseFolders& folders) {
  const auto kind = population_kind("energyplus", given.population);
  if (!kind) return tl::unexpected(kind.error());
  const auto engine = Engine::find();
  if (!engine) return tl::unexpected(engine.error());
  Population population{"energyplus " + kind->name, {}};
  for (const EplusCasePlan& plan : plan_eplus(*kind, given.seed)) {
    population.tasks.push_back(
        {plan.building.id, [plan, folders, engine = *engine](const std::filesystem::path& scratch) {
           return make_eplus_case(plan, engine, scratch, folders);
         }});
  }
  return population;
}

Result<Population> plan_what_is_asked(const Arguments& given, const CaseFolders& folders) {
  const bool plain = given.population == "plain";
  if (!plain && (!given.uses.empty() || given.count > 0)) {
    return failure(ErrorCode::invalid_value, "--uses and --count are of --population plain");
  }
  if (given.world == "energyplus") return of_energyplus(given, folders);
  if (!plain) {
    const auto kind = population_kind("own", given.population);
    if (!kind) return tl::unexpected(kind.error());
    return of_own_world(kind->name, plan_population(*kind, given.seed), folders);
  }
  const auto uses = uses_named(given.uses);
  if (!uses) return tl::unexpected(uses.error());
  constexpr std::size_t most = 999;
  if (given.count < 1 || given.count > most) {
    return failure(ErrorCode::invalid_value,
                   fmt::format("a plain population has 1 to {} cases: give --count", most));
  }
  std::string list;
  for (const simulators::Use use : *uses) {
    list += (list.empty() ? "" : ", ") + std::string(to_string(use));
  }
  return of_own_world("plain (" + list + ")", plan_plain(*uses, given.count, given.seed), folders);
}

/// The folder belongs to one population and seed from its first case on.
Result<void> claim(const Arguments& given, const std::string& name) {
  const std::filesystem::path file = given.out / "population.txt";
  const std::string mine =
      fmt::format("{} with seed {}{}\n", name, given.seed, given.twins ? ", twins kept" : "");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return system::write_file(file, mine);
  const std::string theirs{std::istreambuf_iterator<char>(stream), {}};
  if (theirs == mine) return {};
  return failure(ErrorCode::invalid_value,
                 fmt::format("{} holds {} and this is {}; choose another --out", given.out.string(),
                             theirs.substr(0, theirs.find('\n')), mine.substr(0, mine.size() - 1)));
}

int make(const Arguments& given) {
  const CaseFolders folders{given.out / "cases", given.out / "answers",
                            given.twins ? given.out / "twins" : std::filesystem::path()};
  const auto population = plan_what_is_asked(given, folders);
  if (!population) return failed(population.error().message, 2);
  const std::vector<Task>& tasks = population->tasks;
  const auto range = case_range_of(given.cases, tasks.size());
  if (!range) {
    return failed(fmt::format("--cases {}: give one number or two with a dash, 1 to {}",
                              given.cases, tasks.size()),
                  2);
  }
  for (const auto& folder : {folders.cases, folders.answers}) {
    if (const auto made = system::make_folder(folder); !made) return failed(made.error().message);
  }
  if (std::filesystem::exists(folders.answers / "answers.sha256")) {
    return failed(fmt::format("{} is sealed already; choose another --out", given.out.string()));
  }
  if (const auto same = claim(given, population->name); !same) return failed(same.error().message);
  Maker maker(folders, given.out / "scratch", range->size());
  system::parallel_for(given.threads)(
      range->size(), [&](std::size_t i) { maker.make(tasks[range->first - 1 + i]); });
  std::cerr << '\n';
  if (!maker.error().empty()) return failed(maker.error());
  if (range->size() < tasks.size()) {
    std::cout << "part of the population, not sealed\n";
    return 0;
  }
  const auto hash = seal_answers(folders.answers);
  if (!hash) return failed(hash.error().message);
  std::cout << fmt::format("{} cases of {} with seed {} in {}; answers sealed: {}\n", tasks.size(),
                           population->name, given.seed, folders.cases.string(), *hash);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Draws a blind population: feeds and site files, answers apart and sealed.",
               "blind_make"};
  Arguments given;
  app.add_option("--world", given.world, "whose buildings: own or energyplus")
      ->check(CLI::IsMember({"own", "energyplus"}));
  app.add_option("--population", given.population,
                 "smoke, development, learning, sealed; of our own world also plain")
      ->required();
  app.add_option("--uses", given.uses, "of a plain population, such as office,shop")
      ->delimiter(',');
  app.add_option("--count", given.count, "of a plain population: how many cases");
  app.add_option("--seed", given.seed, "of the population")
      ->required()
      ->check(CLI::NonNegativeNumber);
  app.add_option("--out", given.out, "folder; gets cases/ and answers/")->required();
  app.add_option("--cases", given.cases, "only these, such as 1-20; then nothing is sealed");
  app.add_flag("--twins", given.twins, "also each case without its effects, and its footprint");
  app.add_option("--threads", given.threads, "0: one a core");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return make(given);
}
