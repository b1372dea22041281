#include "adapters/results/learned_priors.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/display/id_words.hpp"
#include "core/population/learned_prior.hpp"
#include "core/text/number_text.hpp"

namespace recald::results {
namespace {

using nlohmann::json;

std::string text_at(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

std::optional<double> number_at(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return {};
  return found->get<double>();
}

std::optional<Prior> prior_at(const json& parameter) {
  const auto found = parameter.find("prior");
  if (found == parameter.end() || !found->is_object()) return {};
  const std::string distribution = text_at(*found, "distribution");
  if (distribution != "triangular" && distribution != "uniform") return {};
  const auto prior = Prior::named(
      distribution,
      {number_at(*found, "min"), number_at(*found, "mode"), number_at(*found, "max"), {}});
  if (!prior) return {};
  return *prior;
}

/// The array of parameters; empty if the document has none.
const json& entries_of(const json& document) {
  static const json none = json::array();
  if (!document.is_object()) return none;
  const auto found = document.find("parameters");
  return found != document.end() && found->is_array() ? *found : none;
}

std::optional<population::SitePosterior> posterior_of(const json& document,
                                                      const std::string& name) {
  for (const json& entry : entries_of(document)) {
    if (!entry.is_object() || text_at(entry, "name") != name) continue;
    const auto prior = prior_at(entry);
    const auto q05 = number_at(entry, "q05");
    const auto q50 = number_at(entry, "q50");
    const auto q95 = number_at(entry, "q95");
    if (!prior || !q05 || !q50 || !q95 || entry["prior"].contains("source")) return {};
    return population::SitePosterior{*q05, *q50, *q95, *prior};
  }
  return {};
}

std::string in_words(const Prior& prior, const std::string& unit) {
  std::string words = fmt::format("{} to {}", number_text(prior.quantile(0.05), 3),
                                  number_text(prior.quantile(0.95), 3));
  if (unit != "-") words += " " + unit;
  return words;
}

LearnedPrior learn(std::span<const json> documents, const Parameter& parameter,
                   std::string_view model) {
  std::vector<population::SitePosterior> sites;
  for (const json& document : documents) {
    if (!document.is_object() || text_at(document, "model") != model ||
        text_at(document, "status") != "converged") {
      continue;
    }
    if (const auto site = posterior_of(document, parameter.name)) sites.push_back(*site);
  }
  LearnedPrior result{parameter.name,
                      parameter.unit,
                      parameter.prior,
                      {},
                      static_cast<int>(sites.size()),
                      static_cast<int>(population::evidence_of(sites).size()),
                      {}};
  const std::string label = display::capitalised(display::parameter_words(parameter.name));
  const auto population = population::estimate_population(sites);
  if (!population) {
    result.sentence =
        fmt::format("{}: no prior is learned; {}.", label, population.error().message);
    return result;
  }
  const Prior learned = population::learned_prior(*population, parameter.prior);
  if (learned == parameter.prior) {
    result.sentence = fmt::format(
        "{}: no prior is learned; the {} sites that say something of it differ as much as "
        "the prior allows.",
        label, population->sites);
    return result;
  }
  result.learned = learned;
  result.sentence = fmt::format(
      "{}: {} instead of {} (90 %), from {} of {} sites.", label, in_words(learned, parameter.unit),
      in_words(parameter.prior, parameter.unit), population->sites, result.sites);
  return result;
}

}  // namespace

std::vector<LearnedPrior> learned_priors(std::span<const json> documents,
                                         std::span<const Parameter> building,
                                         std::string_view model) {
  std::vector<LearnedPrior> priors;
  for (const Parameter& parameter : building) priors.push_back(learn(documents, parameter, model));
  return priors;
}

std::vector<Parameter> parameters_of(const json& document) {
  std::vector<Parameter> parameters;
  for (const json& entry : entries_of(document)) {
    if (!entry.is_object()) continue;
    if (const auto prior = prior_at(entry)) {
      parameters.push_back({text_at(entry, "name"), text_at(entry, "unit"), *prior});
    }
  }
  return parameters;
}

std::string site_file_lines(std::span<const LearnedPrior> priors, std::string_view month) {
  std::string lines;
  for (const LearnedPrior& prior : priors) {
    if (!lines.empty()) lines += '\n';
    lines += fmt::format("[[model.parameter]]\nname = \"{}\"\n", prior.name);
    if (!prior.learned) continue;
    lines += fmt::format("prior = [{}, {}, {}]\nsource = \"portfolio of {} sites, {}\"\n",
                         number_text(prior.learned->min()), number_text(prior.learned->mode()),
                         number_text(prior.learned->max()), prior.informative, month);
  }
  return lines;
}

}  // namespace recald::results
