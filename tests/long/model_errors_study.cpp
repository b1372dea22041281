// How likely the meters of buildings with nothing hidden are at their true parameters, by the sizes
// of the model's own errors: one line of JSON a building, for model_errors.py.
//
//   model_errors_study epc|hourly FOLDER…     each folder with site.toml and truth.json

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "adapters/system/parallel_for.hpp"
#include "core/absent.hpp"
#include "core/assessment/model_errors.hpp"
#include "core/calibration/posterior/posterior.hpp"
#include "core/calibration/samplers/log_sum.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace {

using namespace recald;
using nlohmann::json;

constexpr int kHyperDraws = 48;
const std::vector<double> kShares{0.0, 0.25, 0.5, 0.75, 1.0, 1.5};
const std::vector<double> kLevels{0.0, 0.05, 0.10, 0.15, 0.20, 0.30};

/// The truth where the building's answer has it, within the prior; else the prior's mode.
std::vector<double> truth_of(const std::vector<Parameter>& parameters, const json& truth) {
  std::vector<double> theta = prior_modes(parameters);
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const auto entry = truth["parameters"].find(parameters[j].name);
    if (entry == truth["parameters"].end()) continue;
    const Prior& prior = parameters[j].prior;
    theta[j] = std::clamp(entry->at("value").get<double>(), prior.quantile(1e-4),
                          prior.quantile(1.0 - 1e-4));
  }
  return theta;
}

assessment::Service service_of(const std::string& output) {
  if (output.starts_with("elec")) return assessment::Service::electricity;
  return output.starts_with("chill") ? assessment::Service::cooling : assessment::Service::heating;
}

/// log p(residual) with hyper-parameters averaged over their prior.
double log_likelihood(calibration::Posterior posterior, const Eigen::VectorXd& residual) {
  Rng rng{7, 0};
  Eigen::VectorXd values(kHyperDraws);
  Eigen::VectorXd natural(posterior.parameter_count());
  calibration::Hyperparameters hyper{0.0, 0.0, Eigen::VectorXd(posterior.kernel_dimension())};
  for (Eigen::Index d = 0; d < kHyperDraws; ++d) {
    posterior.to_natural(posterior.draw_start(rng), natural, hyper);
    values(d) = posterior.set_hyperparameters(hyper)
                    ? posterior.log_likelihood_of_residual(residual)
                    : -1e9;
  }
  return calibration::log_sum(values) - std::log(static_cast<double>(kHyperDraws));
}

/// Only thermal daily averages: the profile's meter and peaks tell nothing of these sizes.
void keep_thermal(daemon::PreparedSite& prepared) {
  for (std::size_t k = 0; k < prepared.so_far.outputs.size(); ++k) {
    const auto& output = prepared.so_far.outputs[k];
    if (output.unit != "kW" && service_of(output.name) != assessment::Service::electricity)
      continue;
    prepared.so_far.outputs[k].calibrated = false;
    std::ranges::fill(prepared.problem.outputs[k].values, kAbsent);
  }
}

/// Mean of measured over modelled, by output.
json levels_of(const daemon::PreparedSite& prepared, const std::vector<double>& at_truth) {
  json levels = json::object();
  const std::size_t months = prepared.problem.month_names.size();
  for (std::size_t k = 0; k < prepared.problem.outputs.size(); ++k) {
    double measured = 0.0;
    double modelled = 0.0;
    for (std::size_t i = 0; i < months; ++i) {
      const double value = prepared.problem.outputs[k].values[i];
      if (std::isnan(value)) continue;
      measured += value;
      modelled += at_truth[k * months + i];
    }
    if (measured > 0.0) levels[prepared.problem.outputs[k].name] = modelled / measured - 1.0;
  }
  return levels;
}

json study(const std::string& folder, ModelKind kind) {
  auto site = daemon::open_site(folder + "/site.toml");
  if (!site) return {{"folder", folder}, {"failed", site.error().front()}};
  site->config.model->kind = kind;
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  auto modelled = daemon::load_modelled_site(std::move(*site), now);
  if (!modelled) return {{"folder", folder}, {"failed", modelled.error().message}};
  auto prepared = daemon::prepare_site(modelled->site.config, modelled->site.calendar,
                                       modelled->recording, modelled->weather);
  if (!prepared) return {{"folder", folder}, {"failed", prepared.error().message}};
  keep_thermal(*prepared);
  const json truth = json::parse(std::ifstream{folder + "/truth.json"});
  const std::vector<double> theta = truth_of(prepared->so_far.parameters, truth);
  const calibration::RunContext context{.seed = 1, .executor = system::parallel_for(1)};
  auto design = calibration::run_design(*prepared->model, prepared->problem, 200, context);
  if (!design) return {{"folder", folder}, {"failed", design.error().message}};
  const auto normalisation = calibration::normalise_design(
      design->outputs, prepared->problem.outputs, prepared->model->month_count());
  if (!normalisation) return {{"folder", folder}, {"failed", normalisation.error().message}};
  const auto prior = calibration::make_hyper_prior(calibration::HyperPriorProfile::scaled,
                                                   normalisation->pooled_variance);
  std::vector<assessment::Service> services;
  for (const auto& output : prepared->so_far.outputs) {
    services.push_back(service_of(output.name));
  }
  const auto known = prepared->problem.common_errors;
  Eigen::VectorXd residual;  // the same for all sizes
  json grid = json::array();
  for (const double share : kShares) {
    for (const double cooling : kLevels) {
      for (const double heating : kLevels) {
        const assessment::ModelErrorSizes sizes{share, cooling, heating, 0.0};
        auto errors = assessment::model_errors(
            *prepared->model, prepared->so_far.parameters,
            assessment::spreads_of(prepared->so_far.parameters, sizes), services, sizes);
        prepared->problem.common_errors = known;
        prepared->problem.common_errors.insert(prepared->problem.common_errors.end(),
                                               errors.begin(), errors.end());
        auto posterior = calibration::Posterior::make(
            *prepared->model, prepared->so_far.parameters,
            calibration::normalise_problem(prepared->problem, *normalisation), prior);
        if (!posterior) return {{"folder", folder}, {"failed", posterior.error().message}};
        if (residual.size() == 0) residual = posterior->residual_at(theta);
        grid.push_back({share, cooling, heating, log_likelihood(std::move(*posterior), residual)});
      }
    }
  }
  return {{"folder", folder},
          {"levels", levels_of(*prepared, evaluate(*prepared->model, theta))},
          {"grid", grid}};
}

}  // namespace

int main(int argc, char** argv) {
  const auto kind = argc > 1 ? recald::find_model_kind(argv[1]) : std::nullopt;
  if (!kind || argc < 3) {
    fmt::print(stderr, "model_errors_study epc|hourly FOLDER…\n");
    return 2;
  }
  for (int i = 2; i < argc; ++i) {
    fmt::print("{}\n", study(argv[i], *kind).dump());
    std::fflush(stdout);
  }
  return 0;
}
