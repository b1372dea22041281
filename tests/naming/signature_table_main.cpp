// What naming learns from: for each case of a population the signatures of its meters, those of its
// fitted model, and how each parameter and each possible effect would change them.
//
//   signature_table --population DIR --out DIR [--cases 1-20] [--no-effects]
//
// CASE.json names what CASE.f32 holds: little-endian floats, rows of all signatures. The last row
// is what the same meters show without the effect, where the population has twins.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/absent.hpp"
#include "core/diagnosis/expected_changes.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/diagnose/site_diagnosis.hpp"
#include "daemon/site/model/modelled_site.hpp"
#include "tests/blind/scoring/case_range.hpp"
#include "tests/blind/scoring/result_log.hpp"

namespace {

using namespace recald;
using namespace recald::diagnosis;
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A case as a diagnosis sees it.
Result<SiteProblem> problem_of(const fs::path& folder) {
  auto site = daemon::open_site(folder / "site.toml");
  if (!site) return failure(ErrorCode::malformed, site.error().front());
  if (const auto chosen = daemon::choose_model(site->config, ModelKind::hourly); !chosen) {
    return tl::unexpected(chosen.error());
  }
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  auto modelled = daemon::load_modelled_site(std::move(*site), now);
  if (!modelled) return tl::unexpected(modelled.error());
  return daemon::prepare_diagnosis(*modelled);
}

/// As for a diagnosis. Besides, what people may change one day may begin within the record, and
/// hours are shapes: the third hour shows elsewhere than the first.
std::vector<Candidate> candidates_of(const SiteProblem& site) {
  constexpr std::array<std::string_view, 11> kMayBegin{
      "chiller_part_load",    "clock_offset",      "constant_flow_pumps", "deep_drying",
      "demand_ventilation",   "early_start",       "humidifier",          "seasonal_hot_water",
      "supply_reset_missing", "weekend_operation", "wind_infiltration"};
  std::vector<Candidate> candidates = list_candidates(site).candidates;
  for (Candidate& candidate : candidates) {
    if (candidate.effect->id == "after_hours") candidate.parameters[0].scan = {1.0, 2.0, 4.0};
    if (candidate.effect->id == "early_start") {
      candidate.parameters[0].scan = {0.0, 1.0, 3.0};
      candidate.parameters[1].scan = {0.0, 0.03, 0.1};
    }
  }
  for (std::size_t i = candidates.size(); i-- > 0;) {
    if (std::ranges::find(kMayBegin, candidates[i].effect->id) == kMayBegin.end()) continue;
    candidates.push_back(candidates[i]);
    candidates.back().begins = true;
    candidates.back().parameters.push_back(
        {.name = "first_day", .unit = "d", .prior = UniformPrior{0.0, 1.0}, .neutral = kAbsent});
  }
  return candidates;
}

/// Writes a case's table beside `stem`.
/// @param twin     The same without its effect; null: there is none.
/// @param effects  Whether possible effects are in it.
void write_table(const SiteProblem& site, const SiteProblem* twin, bool effects,
                 const fs::path& stem) {
  const SignatureReader reader(site);
  Predictor predictor(site);
  const SignatureFit fit = fit_signatures(site, reader, predictor);
  std::ofstream file(stem.string() + ".f32", std::ios::binary);
  const auto write = [&](const Eigen::VectorXd& row) {
    const Eigen::VectorXf floats = row.cast<float>();
    file.write(reinterpret_cast<const char*>(floats.data()), floats.size() * 4);
  };
  write(fit.measured);
  write(fit.nominal);
  write(fit.fitted);
  for (Eigen::Index j = 0; j < fit.jacobian.cols(); ++j) write(fit.jacobian.col(j));
  Json shapes = Json::array();
  const auto candidates = effects ? candidates_of(site) : std::vector<Candidate>{};
  expect_changes(site, reader, fit, candidates, predictor, [&](const ExpectedChange& expected) {
    write(expected.change);
    shapes.push_back({{"effect", expected.candidate->key(site)},
                      {"values", expected.values},
                      {"from", expected.from_day},
                      {"to", expected.to_day}});
  });
  if (twin != nullptr) {
    const Eigen::MatrixXd without = reader.read(twin->measured_kW);
    write(Eigen::Map<const Eigen::VectorXd>(without.data(), without.size()));
  }
  Json parameters = Json::array();
  for (std::size_t j = 0; j < site.parameters.size(); ++j) {
    parameters.push_back(
        {{"name", site.parameters[j].name}, {"score", fit.scores[static_cast<Eigen::Index>(j)]}});
  }
  const Json json{
      {"signatures", fit.measured.size()}, {"parameters", parameters}, {"objective", fit.objective},
      {"runs", predictor.runs()},          {"shapes", shapes},         {"twin", twin != nullptr}};
  std::ofstream(stem.string() + ".json") << json.dump();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Tabulates signatures of the cases of a population.", "signature_table"};
  fs::path population, out;
  std::string cases;
  app.add_option("--population", population, "folder that holds cases/")->required();
  app.add_option("--out", out, "folder for the tables")->required();
  app.add_option("--cases", cases, "only these, such as 1-20");
  bool no_effects = false;
  app.add_flag("--no-effects", no_effects, "only the fits: enough where nothing is hidden");
  CLI11_PARSE(app, argc, argv);
  fs::create_directories(out);
  std::ofstream(out / "names.json") << Json(signature_names()).dump(1);
  const auto listed = blind::cases_in(population / "cases");
  if (!listed) {
    std::cerr << listed.error().message << '\n';
    return 1;
  }
  const std::vector<std::string>& names = *listed;
  const auto range = blind::case_range_of(cases, names.size());
  if (!range) {
    std::cerr << fmt::format("--cases {}: give 1 to {}\n", cases, names.size());
    return 2;
  }
  for (std::size_t i = range->first - 1; i < range->last; ++i) {
    if (fs::exists(out / (names[i] + ".json"))) continue;
    const auto begin = std::chrono::steady_clock::now();
    const auto problem = problem_of(population / "cases" / names[i]);
    if (!problem) {
      std::cerr << names[i] << ": " << problem.error().message << '\n';
      continue;
    }
    std::optional<SiteProblem> twin;
    if (const fs::path folder = population / "twins" / names[i]; fs::exists(folder)) {
      auto without = problem_of(folder);
      if (!without) {
        std::cerr << names[i] << ", its twin: " << without.error().message << '\n';
        continue;
      }
      const Eigen::ArrayXXd& with_kW = problem->measured_kW;
      const Eigen::ArrayXXd& without_kW = without->measured_kW;
      if (without_kW.rows() == with_kW.rows() && without_kW.cols() == with_kW.cols() &&
          (without_kW.isFinite() == with_kW.isFinite()).all()) {
        twin = std::move(*without);
      } else {
        std::cerr << names[i] << ": its twin has other gaps, which would be taken for an effect\n";
      }
    }
    const auto loaded = std::chrono::steady_clock::now();
    write_table(*problem, twin ? &*twin : nullptr, !no_effects, out / names[i]);
    const std::chrono::duration<double> load = loaded - begin;
    const std::chrono::duration<double> rest = std::chrono::steady_clock::now() - loaded;
    std::cout << fmt::format("{} {:.1f} s + {:.1f} s", names[i], load.count(), rest.count())
              << std::endl;
  }
  return 0;
}
