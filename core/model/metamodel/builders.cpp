#include "core/model/metamodel/builders.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>
#include <utility>

namespace recald::model::metamodel {
namespace {

using regression::ColumnScale;
using regression::Term;

std::string quoted(const std::string& text) { return "'" + text + "'"; }

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

int index_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

/// The inputs that a regression uses, in its order.
Result<Eigen::MatrixXd> pick_inputs(const std::vector<std::string>& wanted,
                                    const MonthInputs& inputs) {
  assert(inputs.values.rows() == static_cast<Eigen::Index>(inputs.months.size()));
  assert(inputs.values.cols() == static_cast<Eigen::Index>(inputs.names.size()));
  Eigen::MatrixXd picked(inputs.values.rows(), static_cast<Eigen::Index>(wanted.size()));
  for (std::size_t s = 0; s < wanted.size(); ++s) {
    const int column = index_of(inputs.names, wanted[s]);
    if (column < 0) {
      return failure(ErrorCode::not_found,
                     "the meta-model uses the month input " + quoted(wanted[s]) +
                         ", which is not given; there is " + listed(inputs.names));
    }
    picked.col(static_cast<Eigen::Index>(s)) = inputs.values.col(column);
    for (Eigen::Index i = 0; i < picked.rows(); ++i) {
      if (std::isfinite(inputs.values(i, column))) continue;
      return failure(ErrorCode::not_finite,
                     "month input " + quoted(wanted[s]) + " has no number in month " +
                         inputs.months[static_cast<std::size_t>(i)] + "; fill it in");
    }
  }
  return picked;
}

/// Adds the terms of a regression at known month inputs and output type, which leaves a polynomial
/// in the parameters.
class CollapsedRow {
 public:
  /// @param known  Values of variables 0 … known.size() - 1; the parameters follow.
  CollapsedRow(QuadraticCoefficients& coefficients, int output, int month, ColumnScale scale,
               const Eigen::VectorXd& known)
      : coefficients_(coefficients), output_(output), month_(month), scale_(scale), known_(known) {}

  void add_constant_of_scale() { coefficients_.add_constant(output_, month_, scale_.min); }

  void add(double value) { coefficients_.add_constant(output_, month_, value * scale_.range()); }

  void add(const Term& term, double value) {
    double factor = value * scale_.range();
    Term left{-1, -1};
    for (const int variable : {term.first, term.second}) {
      if (variable < 0) continue;
      if (variable < known_.size()) {
        factor *= known_(variable);
      } else {
        (left.first < 0 ? left.first : left.second) = variable - static_cast<int>(known_.size());
      }
    }
    if (left.first < 0) {
      coefficients_.add_constant(output_, month_, factor);
    } else {
      coefficients_.add(output_, month_, left, factor);
    }
  }

 private:
  QuadraticCoefficients& coefficients_;
  int output_;
  int month_;
  ColumnScale scale_;
  const Eigen::VectorXd& known_;
};

struct Regression {
  double intercept;
  std::span<const Term> terms;
  std::span<const double> coefficients;
};

/// @param inputs  (months x columns) scaled; `types` outputs of one meter share the regression.
void collapse(const Regression& regression, const Eigen::MatrixXd& inputs,
              const std::vector<int>& outputs, const std::vector<ColumnScale>& output_scales,
              bool has_type, QuadraticCoefficients& coefficients) {
  for (std::size_t type = 0; type < outputs.size(); ++type) {
    const ColumnScale& scale = output_scales[static_cast<std::size_t>(outputs[type])];
    for (Eigen::Index i = 0; i < inputs.rows(); ++i) {
      Eigen::VectorXd known(inputs.cols() + (has_type ? 1 : 0));
      known.head(inputs.cols()) = inputs.row(i).transpose();
      if (has_type) known(inputs.cols()) = static_cast<double>(type);
      CollapsedRow row(coefficients, outputs[type], static_cast<int>(i), scale, known);
      row.add_constant_of_scale();
      row.add(regression.intercept);
      for (std::size_t t = 0; t < regression.terms.size(); ++t) {
        row.add(regression.terms[t], regression.coefficients[t]);
      }
    }
  }
}

/// "a", "a:b" or "a^2" as a term of the variables.
Result<Term> parse_term(const std::string& name, const std::vector<std::string>& variables) {
  const auto unknown = [&](const std::string& factor) {
    return failure(ErrorCode::invalid_value,
                   "the term " + quoted(name) + " of the meta-model has " + "an unknown factor " +
                       quoted(factor) + "; known are " + listed(variables));
  };
  const auto colon = name.find(':');
  std::string first = name.substr(0, colon);
  std::string second = colon == std::string::npos ? "" : name.substr(colon + 1);
  if (second.find(':') != std::string::npos) {
    return failure(ErrorCode::invalid_value,
                   "the term " + quoted(name) +
                       " of the meta-model has more than two factors; only main effects, squares "
                       "and products of two are understood");
  }
  if (colon == std::string::npos && first.ends_with("^2")) {
    first.resize(first.size() - 2);
    second = first;
  }
  Term term{index_of(variables, first)};
  if (term.first < 0) return unknown(first);
  if (colon == std::string::npos && second.empty()) return term;
  term.second = index_of(variables, second);
  if (term.second < 0) return unknown(second);
  return term;
}

struct ParsedTerms {
  double intercept = 0.0;
  std::vector<Term> terms;
  std::vector<double> coefficients;
};

Result<ParsedTerms> parse_terms(const GivenRegression& given,
                                const std::vector<std::string>& variables) {
  ParsedTerms parsed;
  std::set<std::string> seen;
  for (const NamedCoefficient& term : given.terms) {
    if (!std::isfinite(term.value)) {
      return failure(ErrorCode::invalid_value,
                     "the coefficient of " + quoted(term.term) + " in the meta-model is no number");
    }
    if (!seen.insert(term.term).second) {
      return failure(ErrorCode::invalid_value,
                     "the term " + quoted(term.term) + " of the meta-model comes twice");
    }
    if (term.term == "(Intercept)") {
      parsed.intercept = term.value;
      continue;
    }
    const auto known = TRY(parse_term(term.term, variables));
    parsed.terms.push_back(known);
    parsed.coefficients.push_back(term.value);
  }
  return parsed;
}

}  // namespace

Result<QuadraticModel> model_of(const regression::SeedForm& form, const MonthInputs& inputs) {
  const auto picked = TRY(pick_inputs(form.inputs, inputs));
  const Eigen::MatrixXd scaled = regression::scale_columns(
      regression::input_columns(form.inputs, picked, form.wind_in_degrees).values,
      form.input_columns.scales);
  QuadraticCoefficients coefficients(form.parameter_scales, static_cast<int>(form.outputs.size()),
                                     static_cast<int>(scaled.rows()));
  for (const regression::SeedFormMeter& meter : form.meters) {
    const std::vector<int> outputs = meter.outputs.existing();
    collapse({meter.intercept,
              meter.terms,
              {meter.coefficients.data(), static_cast<std::size_t>(meter.coefficients.size())}},
             scaled, outputs, form.output_scales, outputs.size() > 1, coefficients);
  }
  return QuadraticModel(coefficients);
}

Result<GaussianModel> model_of(const regression::MonthlyForm& form,
                               std::span<const std::string> months) {
  std::vector<int> places;
  for (const std::string& month : months) {
    const int place = index_of(form.months, month);
    if (place < 0) {
      return failure(ErrorCode::not_found,
                     "month " + month + " is not in the design (" + form.months.front() + " to " +
                         form.months.back() +
                         "), and the monthly form says nothing about other months; use the seed's "
                         "form for them");
    }
    places.push_back(place);
  }
  return GaussianModel(form, places);
}

std::vector<ColumnScale> prior_scales(std::span<const Parameter> parameters) {
  std::vector<ColumnScale> scales;
  for (const Parameter& parameter : parameters) {
    assert(std::isfinite(parameter.prior.min()) && std::isfinite(parameter.prior.max()));
    scales.push_back({parameter.prior.min(), parameter.prior.max()});
  }
  return scales;
}

Result<QuadraticModel> model_of(const GivenRegression& given, const MonthInputs& inputs) {
  assert(given.parameters.size() == given.parameter_scales.size());
  assert(given.inputs.size() == given.input_scales.size());
  assert(given.output_scales.size() == 1 || given.output_scales.size() == 2);
  const bool has_type = given.output_scales.size() == 2;
  std::vector<std::string> variables = given.inputs;
  if (has_type) variables.emplace_back("out");
  variables.insert(variables.end(), given.parameters.begin(), given.parameters.end());
  const auto parsed = TRY(parse_terms(given, variables));
  const auto picked = TRY(pick_inputs(given.inputs, inputs));

  QuadraticCoefficients coefficients(given.parameter_scales,
                                     static_cast<int>(given.output_scales.size()),
                                     static_cast<int>(picked.rows()));
  collapse({parsed.intercept, parsed.terms, parsed.coefficients},
           regression::scale_columns(picked, given.input_scales),
           has_type ? std::vector<int>{0, 1} : std::vector<int>{0}, given.output_scales, has_type,
           coefficients);
  return QuadraticModel(coefficients);
}

}  // namespace recald::model::metamodel
