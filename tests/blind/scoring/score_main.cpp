/// blind_score: seals answers, keeps results, opens the answers once and scores.
#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <iterator>

#include "tests/blind/scoring/handed_in.hpp"
#include "tests/blind/scoring/open_answers.hpp"
#include "tests/blind/scoring/result_log.hpp"
#include "tests/blind/scoring/seal.hpp"

namespace {

using recald::Result;
using recald::blind::OpenRequest;
using recald::blind::Reruns;

constexpr int kExitFailure = 1;
constexpr int kExitUsage = 2;

struct Options {
  OpenRequest open;
  std::string truth;
  std::string world = "energyplus";
  std::string population;
  std::string results;
  std::string method = "recald";
  bool allow_rerun = false;

  [[nodiscard]] Reruns reruns() const { return allow_rerun ? Reruns::replace : Reruns::refuse; }
};

Result<std::string> run_hand_in(const Options& options) {
  const auto catalogue = recald::blind::read_classes(options.open.classes);
  if (!catalogue) return tl::unexpected(catalogue.error());
  const auto count = recald::blind::write_handed_in(options.truth, options.world, *catalogue,
                                                    options.open.answers);
  if (!count) return tl::unexpected(count.error());
  return std::to_string(*count) + " answers in " + options.open.answers.string() + "\n";
}

Result<std::string> run_seal(const Options& options) {
  auto whole = recald::blind::seal_answers(options.open.answers);
  if (whole) *whole += "\n";
  return whole;
}

Result<std::string> run_pending(const Options& options) {
  const auto pending =
      recald::blind::pending_cases(options.population, options.results, options.method);
  if (!pending) return tl::unexpected(pending.error());
  for (const std::string& torn : pending->torn) std::cerr << "blind_score: " << torn << '\n';
  std::string lines;
  for (const std::string& name : pending->cases) lines += name + "\n";
  return lines;
}

Result<std::string> run_append(const Options& options) {
  const std::string line{std::istreambuf_iterator<char>(std::cin), {}};
  const auto appended = recald::blind::append_result(options.results, line, options.reruns());
  if (!appended) return tl::unexpected(appended.error());
  return std::string();
}

Result<std::string> run_open(const Options& options) {
  OpenRequest request = options.open;
  request.reruns = options.reruns();
  request.options.method = options.method;
  request.now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  request.scorer_version = RECALD_VERSION;
  return recald::blind::open_answers(request);
}

void add_hand_in(CLI::App& app, Options& options) {
  CLI::App* hand_in =
      app.add_subcommand("hand-in", "makes answers of a truth.json that somebody else wrote");
  hand_in->add_option("--truth", options.truth, "JSON {case: {archetype, weather, effects}}")
      ->required();
  hand_in->add_option("--answers", options.open.answers, "folder that gets <case>.json")
      ->required();
  hand_in
      ->add_option("--classes", options.open.classes, "JSON {effect: class} of the whole catalogue")
      ->required();
  hand_in->add_option("--world", options.world, "whose buildings: own or energyplus")
      ->capture_default_str()
      ->check(CLI::IsMember({"own", "energyplus"}));
}

void add_seal(CLI::App& app, Options& options) {
  CLI::App* seal = app.add_subcommand("seal", "hashes the answers; prints the hash to publish");
  seal->add_option("--answers", options.open.answers, "folder with <case>.json")->required();
}

void add_pending(CLI::App& app, Options& options) {
  CLI::App* pending = app.add_subcommand("pending", "lists the cases without a result");
  pending->add_option("--population", options.population, "folder with one folder a case")
      ->required();
  pending->add_option("--results", options.results, "results file; may not exist yet")->required();
  pending->add_option("--method", options.method)->capture_default_str();
}

void add_append(CLI::App& app, Options& options) {
  CLI::App* append =
      app.add_subcommand("append", "adds the result on standard input to a results file");
  append->add_option("--results", options.results, "results file; made if absent")->required();
  append->add_flag("--allow-rerun", options.allow_rerun, "the case may have a result already");
}

void add_open(CLI::App& app, Options& options) {
  OpenRequest& open = options.open;
  CLI::App* command = app.add_subcommand("open", "verifies the seal, opens the answers, scores");
  command->add_option("--answers", open.answers, "folder with <case>.json and answers.sha256")
      ->required();
  command->add_option("--results", open.results, "results files, read as one")->required();
  command->add_option("--out", open.out, "scores.json; scores.md goes beside it")->required();
  command->add_option("--published", open.published, "the hash that was published");
  command->add_option("--classes", open.classes, "JSON {effect: class} of the whole catalogue");
  command->add_option("--method", options.method, "the method under test")->capture_default_str();
  command->add_option("--bins", open.options.reliability_bins, "of the reliability table")
      ->capture_default_str()
      ->check(CLI::Range(2, 20));
  command->add_flag("--partial", open.partial, "score although cases are missing");
  command->add_flag("--allow-rerun", options.allow_rerun, "of two results the later one counts");
}

Result<std::string> run(const CLI::App& app, const Options& options) {
  if (app.got_subcommand("hand-in")) return run_hand_in(options);
  if (app.got_subcommand("seal")) return run_seal(options);
  if (app.got_subcommand("pending")) return run_pending(options);
  if (app.got_subcommand("append")) return run_append(options);
  return run_open(options);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Keeps the results of a blind test and scores them against sealed answers.",
               "blind_score"};
  app.require_subcommand(1);
  Options options;
  add_hand_in(app, options);
  add_seal(app, options);
  add_pending(app, options);
  add_append(app, options);
  add_open(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  const auto said = run(app, options);
  if (!said) {
    std::cerr << "blind_score: " << said.error().message << '\n';
    return kExitFailure;
  }
  std::cout << *said;
  return 0;
}
