#include "daemon/site/results/design_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "adapters/shapes/shape_json.hpp"

SHAPE(recald::regression::FitQuality, r2_in_sample, r2_left_out, r2_left_out_within_months);
SHAPE(recald::screening::ScreenedOutput, name, penalty, penalty_best, selected, r2_left_out);
SHAPE(recald::screening::ParameterEffect, selected, frequency, share, change_mean, change_least,
      change_most);

namespace recald::daemon {
namespace {

// Keys in the order they are written: files are read by people too.
using Json = nlohmann::ordered_json;
using regression::ColumnScale;
using regression::DesignQuality;
using regression::FitQuality;

const char* verdict_word(screening::Verdict verdict) {
  switch (verdict) {
    case screening::Verdict::influential:
      return "influential";
    case screening::Verdict::minor:
      return "minor";
    case screening::Verdict::not_detected:
      return "not_detected";
  }
  return "not_detected";
}

void add_facts(Json& json, const std::vector<std::string>& notes, const RunFacts& facts) {
  json["warnings"] = notes;
  json["runs"] = facts.design_runs;
  json["seed"] = facts.seed;
  json["data_revision"] = facts.data_revision;
  json["recald_version"] = facts.recald_version;
  json["wall_s"] = facts.wall_s;
}

std::string notes_text(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += "! " + note + "\n";
  return text;
}

std::size_t longest(const std::vector<std::string>& names, std::size_t least) {
  for (const std::string& name : names) least = std::max(least, name.size());
  return least;
}

Json form_json(const DesignQuality& quality) {
  Json json = shapes::json_of(quality.all);
  Json outputs = Json::object();
  for (const regression::OutputQuality& output : quality.outputs) {
    outputs[output.name] = shapes::json_of(output.fit);
    outputs[output.name]["sigma_r"] = output.sigma_r;
  }
  json["outputs"] = outputs;
  return json;
}

Json scales_json(const std::vector<std::string>& names, const std::vector<ColumnScale>& scales) {
  Json json = Json::object();
  for (std::size_t j = 0; j < names.size(); ++j) json[names[j]] = {scales[j].min, scales[j].max};
  return json;
}

Json seed_terms_json(const regression::SeedForm& form) {
  Json terms = Json::array();
  for (const regression::SeedFormMeter& meter : form.meters) {
    const auto add = [&](const std::string& term, double coefficient) {
      terms.push_back(
          {{"meter", meter.outputs.meter}, {"term", term}, {"coefficient", coefficient}});
    };
    add("(Intercept)", meter.intercept);
    for (std::size_t t = 0; t < meter.terms.size(); ++t) {
      add(regression::term_name(meter.terms[t], meter.variables),
          meter.coefficients[static_cast<Eigen::Index>(t)]);
    }
  }
  return terms;
}

/// A length is the share of a parameter's range over which a pattern changes much.
Json patterns_json(const regression::MonthlyForm& form) {
  Json patterns = Json::array();
  for (std::size_t k = 0; k < form.fits.size(); ++k) {
    for (const regression::MonthPattern& pattern : form.fits[k].patterns) {
      const regression::Kernel& kernel = pattern.amount.kernel;
      Json loadings = Json::object();
      for (std::size_t i = 0; i < form.months.size(); ++i) {
        loadings[form.months[i]] = pattern.loadings(static_cast<Eigen::Index>(i));
      }
      Json lengths = Json::object();
      for (std::size_t j = 0; j < form.parameters.size(); ++j) {
        lengths[form.parameters[j]] =
            1.0 / std::sqrt(kernel.relevance(static_cast<Eigen::Index>(j)));
      }
      patterns.push_back({{"output", form.outputs[k]},
                          {"loadings", loadings},
                          {"lengths", lengths},
                          {"linear", kernel.linear},
                          {"quadratic", kernel.quadratic},
                          {"noise", kernel.noise}});
    }
  }
  return patterns;
}

Json scaling_json(const FittedMetamodel& fitted) {
  if (fitted.form == MetamodelForm::monthly) {
    const regression::MonthlyForm& form = *fitted.monthly_form;
    return {{"parameters", scales_json(form.parameters, form.parameter_scales)},
            {"outputs", scales_json(form.outputs, form.output_scales)}};
  }
  const regression::SeedForm& form = *fitted.seed_form;
  return {{"parameters", scales_json(form.parameters, form.parameter_scales)},
          {"inputs", scales_json(form.input_columns.names, form.input_columns.scales)},
          {"outputs", scales_json(form.outputs, form.output_scales)}};
}

std::size_t count_terms(const regression::SeedForm& form) {
  std::size_t count = 0;
  for (const auto& meter : form.meters) count += meter.terms.size();
  return count;
}

std::size_t count_patterns(const regression::MonthlyForm& form) {
  std::size_t count = 0;
  for (const auto& fit : form.fits) count += fit.patterns.size();
  return count;
}

bool has(const FittedMetamodel& fitted, MetamodelForm form) {
  return form == MetamodelForm::seed ? fitted.seed_form.has_value()
                                     : fitted.monthly_form.has_value();
}

}  // namespace

std::string screen_json(const screening::Screening& screening,
                        const std::vector<Parameter>& parameters,
                        const std::vector<std::string>& notes, const RunFacts& facts) {
  Json list = Json::array();
  for (std::size_t j = 0; j < screening.parameters.size(); ++j) {
    const screening::ScreenedParameter& parameter = screening.parameters[j];
    Json effects = Json::object();
    for (std::size_t k = 0; k < parameter.effects.size(); ++k) {
      effects[screening.outputs[k].name] = shapes::json_of(parameter.effects[k]);
    }
    list.push_back({{"name", parameter.name},
                    {"unit", parameters[j].unit},
                    {"verdict", verdict_word(parameter.verdict)},
                    {"frequency", parameter.frequency},
                    {"share", parameter.share},
                    {"strongest_output",
                     screening.outputs[static_cast<std::size_t>(parameter.strongest_output)].name},
                    {"effects", effects}});
  }
  Json json = {{"influential", screening.influential()},
               {"parameters", list},
               {"outputs", shapes::json_of(screening.outputs)}};
  add_facts(json, notes, facts);
  return json.dump(2) + "\n";
}

std::string screen_table(const screening::Screening& screening,
                         const std::vector<Parameter>& parameters,
                         const std::vector<std::string>& notes) {
  std::vector<std::size_t> order(parameters.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return screening.parameters[a].share > screening.parameters[b].share;
  });
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) names.push_back(parameter.name);
  const std::size_t width = longest(names, 10);
  std::string text =
      fmt::format("{:<{}}  {:<12}  {:<12}{:>7}{:>13}  {:>22}  {}\n", "parameter", width, "unit",
                  "verdict", "share", "half-samples", "one sd of it changes", "most in");
  for (const std::size_t j : order) {
    const screening::ScreenedParameter& parameter = screening.parameters[j];
    const auto strongest = static_cast<std::size_t>(parameter.strongest_output);
    const screening::ParameterEffect& effect = parameter.effects[strongest];
    text += fmt::format("{:<{}}  {:<12}  {:<12}{:>5.1f} %{:>11.0f} %  {:>22}  {}\n", parameter.name,
                        width, parameters[j].unit, verdict_word(parameter.verdict),
                        100.0 * parameter.share, 100.0 * parameter.frequency,
                        fmt::format("{:+.3g} … {:+.3g}", effect.change_least, effect.change_most),
                        screening.outputs[strongest].name);
  }
  text +=
      "\nshare: of the output's spread over the runs, months pooled; half-samples: in how many of "
      "the runs' random halves the lasso selects it.\n\n";
  for (const screening::ScreenedOutput& output : screening.outputs) {
    text += fmt::format("{}: {} parameters selected, left-out R2 {:.3f}\n", output.name,
                        output.selected, output.r2_left_out);
  }
  const auto influential = screening.influential();
  text += fmt::format("\n{} of {} are influential: {}\n", influential.size(), parameters.size(),
                      fmt::join(influential, ", "));
  return text + notes_text(notes);
}

std::string metamodel_json(const FittedMetamodel& fitted, const std::vector<std::string>& notes,
                           const RunFacts& facts,
                           const std::vector<regression::CheckedOutput>& checked) {
  const DesignQuality& quality = fitted.quality();
  Json sigma_r = Json::object();
  for (const regression::OutputQuality& output : quality.outputs) {
    sigma_r[output.name] = output.sigma_r;
  }
  Json forms = Json::object();
  for (const MetamodelForm form : {MetamodelForm::seed, MetamodelForm::monthly}) {
    if (!has(fitted, form)) continue;
    Json entry = form_json(fitted.quality(form));
    if (form == MetamodelForm::seed) {
      entry["coefficients"] = count_terms(*fitted.seed_form);
    } else {
      entry["patterns"] = count_patterns(*fitted.monthly_form);
    }
    forms[std::string{to_string(form)}] = std::move(entry);
  }
  Json json = {{"form", to_string(fitted.form)},
               {"why", fitted.why},
               {"r2_in_sample", quality.all.r2_in_sample},
               {"r2_left_out", quality.all.r2_left_out},
               {"sigma_r", sigma_r},
               {"forms", forms},
               {"scaling", scaling_json(fitted)}};
  if (fitted.form == MetamodelForm::seed) {
    json["terms"] = seed_terms_json(*fitted.seed_form);
  } else {
    json["patterns"] = patterns_json(*fitted.monthly_form);
  }
  for (const regression::CheckedOutput& output : checked) {
    json["check"][output.name] = {{"cvrmse", output.cvrmse},
                                  {"r2_median_month", output.r2_median_month},
                                  {"r2_worst_month", output.r2_worst_month},
                                  {"worst_month", output.worst_month},
                                  {"error_of_worst_month", output.error_of_worst}};
  }
  add_facts(json, notes, facts);
  return json.dump(2) + "\n";
}

std::string metamodel_table(const FittedMetamodel& fitted, const std::vector<std::string>& notes,
                            const std::vector<regression::CheckedOutput>& checked) {
  std::vector<std::string> names;
  for (const auto& output : fitted.quality().outputs) names.push_back(output.name);
  const std::size_t width = longest(names, 11);
  std::string text;
  for (const MetamodelForm form : {MetamodelForm::seed, MetamodelForm::monthly}) {
    if (!has(fitted, form)) continue;
    const DesignQuality& quality = fitted.quality(form);
    text += form == MetamodelForm::seed
                ? fmt::format("form seed: {} coefficients\n", count_terms(*fitted.seed_form))
                : fmt::format("form monthly: {} patterns of months\n",
                              count_patterns(*fitted.monthly_form));
    text += fmt::format("{:<{}}{:>14}{:>14}{:>16}{:>12}\n", "output", width, "R2 in sample",
                        "R2 left out", "within months", "sigma_r");
    const auto line = [&](const std::string& name, const FitQuality& fit,
                          const std::string& sigma_r) {
      text +=
          fmt::format("{:<{}}{:>14.4f}{:>14.4f}{:>16.4f}{:>12}\n", name, width, fit.r2_in_sample,
                      fit.r2_left_out, fit.r2_left_out_within_months, sigma_r);
    };
    for (const auto& output : quality.outputs) {
      line(output.name, output.fit, fmt::format("{:.4g}", output.sigma_r));
    }
    line("all outputs", quality.all, "");
    text += "\n";
  }
  text += fmt::format("Chosen: {}: {}\n", to_string(fitted.form), fitted.why);
  if (fitted.form == MetamodelForm::monthly) {
    text += "It speaks of the design's months alone; for other months the seed's form is needed.\n";
  }
  if (!checked.empty()) {
    text += fmt::format("\n{:<{}}{:>12}{:>18}{:>24}\n", "runs to check", width, "CV(RMSE)",
                        "R2, median month", "worst month, its error");
    for (const regression::CheckedOutput& output : checked) {
      text += fmt::format("{:<{}}{:>11.2f}%{:>18.4f}{:>24}\n", output.name, width,
                          100.0 * output.cvrmse, output.r2_median_month,
                          fmt::format("{:.4f} {} {:.2f}%", output.r2_worst_month,
                                      output.worst_month, 100.0 * output.error_of_worst));
    }
  }
  return text + notes_text(notes);
}

}  // namespace recald::daemon
