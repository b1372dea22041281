// What naming learns from: for each case of a population what the signatures of its meters say.
//
//   signature_table --population DIR --out DIR [--cases 1-20] [--twins] [--null FILE]
//
// Without a null: what the fitted model leaves unexplained, for null.py. With one: the evidence for
// each possible effect, for study.py. Months of a diagnosis' final check are not read.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/diagnosis/naming/signature_fit.hpp"
#include "core/diagnosis/naming/signature_names.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/diagnose/site_diagnosis.hpp"
#include "daemon/site/model/modelled_site.hpp"
#include "tests/blind/population/case_range.hpp"

namespace {

using namespace recald;
using namespace recald::diagnosis;
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A case as a diagnosis sees it before the months of the final check are read.
Result<SiteProblem> problem_of(const fs::path& folder) {
  auto site = daemon::open_site(folder / "site.toml");
  if (!site) return failure(ErrorCode::malformed, site.error().front());
  if (const auto chosen = daemon::choose_model(site->config, ModelKind::hourly); !chosen) {
    return tl::unexpected(chosen.error());
  }
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  auto modelled = daemon::load_modelled_site(std::move(*site), now);
  if (!modelled) return tl::unexpected(modelled.error());
  auto problem = daemon::prepare_diagnosis(*modelled);
  if (!problem) return tl::unexpected(problem.error());
  return without_shown_months(std::move(*problem));
}

/// What null.py has learnt, without the case's own row.
SignatureNull null_from(const Json& json, const std::string& name) {
  const auto vector_of = [](const Json& list) {
    Eigen::VectorXd values(std::ssize(list));
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const Json& value = list[static_cast<std::size_t>(i)];
      values[i] = value.is_null() ? kAbsent : value.get<double>();
    }
    return values;
  };
  SignatureNull null;
  null.spread = vector_of(json["spread"]);
  null.centre = json["centre"].get<std::map<std::string, double>>();
  null.reach = json["reach"].get<std::map<std::string, double>>();
  null.own = Eigen::VectorXd::Constant(null.spread.size(), json["own"].get<double>());
  const Json& rows = json["rows"];
  null.patterns.resize(null.spread.size(), std::ssize(rows));
  Eigen::Index k = 0;
  for (const Json& row : rows) {
    if (row["name"] == name) continue;
    null.patterns.col(k++) = vector_of(row["values"]);
  }
  null.patterns.conservativeResize(Eigen::NoChange, k);
  return null;
}

/// Folders that hold a site file, sorted.
std::vector<std::string> cases_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (fs::exists(entry.path() / "site.toml")) names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

Json list_of(const Eigen::VectorXd& values) {
  Json list = Json::array();
  for (const double value : values) {
    list.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
  }
  return list;
}

Json scores_of(const SiteProblem& site, const Eigen::VectorXd& scores) {
  Json named = Json::object();
  for (std::size_t j = 0; j < site.parameters.size(); ++j) {
    named[site.parameters[j].name] = scores[static_cast<Eigen::Index>(j)];
  }
  return named;
}

/// What the fitted model leaves unexplained.
Json left_by_fit(const SiteProblem& site) {
  Predictor predictor(site);
  const SignatureFit fit = fit_signatures(site, SignatureReader(site), predictor);
  return {{"left", list_of(fit.measured - fit.fitted)}, {"scores", scores_of(site, fit.scores)}};
}

Json evidence_json(const SiteProblem& site, const SignatureNull& null) {
  Predictor predictor(site);
  const auto candidates = list_candidates(site).candidates;
  const SignatureEvidence evidence = evidence_of(site, candidates, null, predictor);
  const Eigen::MatrixXd features = effect_features(evidence);
  Json effects = Json::array();
  for (const EffectEvidence& e : evidence.effects) {
    const auto row = std::ssize(effects);
    effects.push_back({{"effect", e.shape.candidate->effect->id},
                       {"shape", e.shape.candidate->key(site)},
                       {"values", list_of(Eigen::Map<const Eigen::VectorXd>(e.values.data(),
                                                                            std::ssize(e.values)))},
                       {"log_gain", e.log_gain},
                       {"misfit", e.misfit},
                       {"factor", e.factor},
                       {"fitted", e.is_fitted},
                       {"features", list_of(features.row(row).transpose())}});
  }
  return {{"misfit", evidence.misfit},
          {"count", evidence.count},
          {"features", list_of(site_features(evidence))},
          {"runs", predictor.runs()},
          {"effects", effects}};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Tabulates what signatures say of the cases of a population.", "signature_table"};
  fs::path population, out, null_file;
  std::string cases;
  bool twins = false;
  app.add_option("--population", population, "folder that holds cases/")->required();
  app.add_option("--out", out, "folder for the tables")->required();
  app.add_option("--cases", cases, "only these, such as 1-20");
  app.add_flag("--twins", twins, "the buildings without what is hidden in them");
  app.add_option("--null", null_file, "of null.py: evidence beside it");
  CLI11_PARSE(app, argc, argv);
  const fs::path folder = population / (twins ? "twins" : "cases");
  const std::vector<std::string> names = cases_in(folder);
  if (names.empty()) {
    std::cerr << "no case (a folder with a site.toml) in '" << folder.string() << "'\n";
    return 1;
  }
  const auto range = blind::case_range_of(cases, names.size());
  if (!range) {
    std::cerr << fmt::format("--cases {}: give 1 to {}\n", cases, names.size());
    return 2;
  }
  std::optional<Json> null;
  if (!null_file.empty()) {
    null = Json::parse(std::ifstream(null_file), nullptr, false);
    if (null->is_discarded()) {
      std::cerr << null_file.string() << ": not a file of null.py\n";
      return 1;
    }
    const std::size_t entries = signature_names().size() * kSignatureMeters;
    if ((*null)["spread"].size() != entries) {
      std::cerr << fmt::format("{}: {} signatures instead of {}; run null.py again\n",
                               null_file.string(), (*null)["spread"].size(), entries);
      return 1;
    }
  }
  fs::create_directories(out);
  for (std::size_t i = range->first - 1; i < range->last; ++i) {
    const fs::path file = out / (names[i] + ".json");
    if (fs::exists(file)) continue;
    const auto begin = std::chrono::steady_clock::now();
    const auto problem = problem_of(folder / names[i]);
    if (!problem) {
      std::cerr << names[i] << ": " << problem.error().message << '\n';
      continue;
    }
    const Json json =
        null ? evidence_json(*problem, null_from(*null, names[i])) : left_by_fit(*problem);
    const fs::path unfinished = file.string() + ".part";
    std::ofstream(unfinished) << json.dump();
    fs::rename(unfinished, file);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    std::cout << fmt::format("{} {:.1f} s", names[i], took.count()) << std::endl;
  }
  return 0;
}
