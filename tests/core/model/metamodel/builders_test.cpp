#include "core/model/metamodel/builders.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string>

#include "tests/core/regression/design_folder.hpp"
#include "tests/core/regression/made_design.hpp"
#include "tests/support/data_folders.hpp"

namespace recald::model::metamodel {
namespace {

using regression::DesignData;

MonthInputs inputs_of(const DesignData& design) {
  return {design.inputs, design.months, design.month_inputs};
}

/// All outputs of the model at each of the design's runs.
Eigen::MatrixXd predictions(auto model, const Eigen::MatrixXd& theta) {
  Eigen::MatrixXd all(theta.rows(), model.output_count() * model.month_count());
  std::vector<double> outputs(static_cast<std::size_t>(all.cols()));
  for (Eigen::Index r = 0; r < theta.rows(); ++r) {
    std::vector<double> point(static_cast<std::size_t>(theta.cols()));
    for (std::size_t j = 0; j < point.size(); ++j) {
      point[j] = theta(r, static_cast<Eigen::Index>(j));
    }
    model.evaluate(point, outputs);
    for (std::size_t c = 0; c < outputs.size(); ++c)
      all(r, static_cast<Eigen::Index>(c)) = outputs[c];
  }
  return all;
}

/// Largest error of a prediction against the design, as a share of the output's range.
double largest_error(const DesignData& design, const Eigen::MatrixXd& predicted) {
  double largest = 0.0;
  const auto scales = regression::output_scales(design);
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(scales.size()); ++k) {
    const Eigen::Index months = design.month_count();
    const double error =
        (predicted.middleCols(k * months, months) - design.output(k)).cwiseAbs().maxCoeff();
    largest = std::max(largest, error / scales[static_cast<std::size_t>(k)].range());
  }
  return largest;
}

TEST(MetaModel, OfTheSeedFormPredictsTheDesignInUnits) {
  const DesignData design = regression::made_design(60, 12, 0.0);
  Rng rng(1);
  const auto form = regression::fit_seed_form(design, {}, rng);
  ASSERT_TRUE(form.has_value()) << form.error().message;
  const auto model = model_of(*form, inputs_of(design));
  ASSERT_TRUE(model.has_value()) << model.error().message;
  EXPECT_EQ(model->output_count(), 3);
  EXPECT_EQ(model->month_count(), 12);
  EXPECT_LT(largest_error(design, predictions(*model, design.theta)), 1e-8);
}

// The regression was exact, so it holds in months of which the design knows nothing; the inputs
// come in another order, with one that it does not use.
TEST(MetaModel, OfTheSeedFormSpeaksOfOtherMonths) {
  Rng rng(2);
  const auto form = regression::fit_seed_form(regression::made_design(60, 12, 0.0), {}, rng);
  const DesignData longer = regression::made_design(60, 16, 0.0);
  MonthInputs inputs{{"sun", "winddir", "drybulb"}, longer.months, Eigen::MatrixXd(16, 3)};
  inputs.values << Eigen::VectorXd::Zero(16), longer.month_inputs.col(1),
      longer.month_inputs.col(0);
  const auto model = model_of(*form, inputs);
  ASSERT_TRUE(model.has_value()) << model.error().message;
  EXPECT_LT(largest_error(longer, predictions(*model, longer.theta)), 1e-7);
}

TEST(MetaModel, OfTheSeedFormNeedsItsInputs) {
  const DesignData design = regression::made_design(60, 12, 0.0);
  Rng rng(3);
  const auto form = regression::fit_seed_form(design, {}, rng);
  MonthInputs inputs = inputs_of(design);
  inputs.names[0] = "temperature";
  const auto missing = model_of(*form, inputs);
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().code, ErrorCode::not_found);
  EXPECT_EQ(missing.error().message,
            "the meta-model uses the month input 'drybulb', which is not given; there is "
            "temperature, winddir");
  inputs = inputs_of(design);
  inputs.values(2, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(model_of(*form, inputs).error().message,
            "month input 'winddir' has no number in month 2016-3; fill it in");
}

TEST(MetaModel, OfTheMonthlyFormPredictsSomeMonthsInAnyOrder) {
  const DesignData design = regression::made_design(60, 6, 0.0);
  const auto form = regression::fit_monthly_form(design);
  ASSERT_TRUE(form.has_value()) << form.error().message;
  const auto all = model_of(*form, design.months);
  ASSERT_TRUE(all.has_value());
  const Eigen::MatrixXd of_all = predictions(*all, design.theta);
  EXPECT_LT(largest_error(design, of_all), 1e-2);

  const std::vector<std::string> two{"2016-5", "2016-2"};
  const Eigen::MatrixXd predicted = predictions(*model_of(*form, two), design.theta);
  EXPECT_LT((predicted.col(0) - of_all.col(4)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((predicted.col(3) - of_all.col(6 + 1)).cwiseAbs().maxCoeff(), 1e-9);
}

/// A load that stops where nothing is needed, of two of the parameters, in months of more and less.
DesignData bent_design(int runs, std::uint64_t seed) {
  DesignData design = regression::made_design(runs, 6, 0.0, seed);
  for (Eigen::Index r = 0; r < design.runs(); ++r) {
    const double set_point = (design.theta(r, 0) - 20.0) / 8.0;
    const double air = (design.theta(r, 1) - 0.3) / 0.9;
    for (int i = 0; i < 6; ++i) {
      const double hot = 0.3 * i - 0.5 + air - 1.5 * set_point;
      design.values(r, i) = 1000.0 * std::log1p(std::exp(4.0 * hot));
    }
  }
  return design;
}

TEST(MetaModel, OfTheMonthlyFormFollowsALoadThatStops) {
  const DesignData check = bent_design(40, 2);
  const auto form = regression::fit_monthly_form(bent_design(120, 1));
  ASSERT_TRUE(form.has_value()) << form.error().message;
  const Eigen::MatrixXd predicted = predictions(*model_of(*form, check.months), check.theta);
  const double error = std::sqrt((predicted.leftCols(6) - check.output(0)).cwiseAbs2().mean());
  EXPECT_LT(error, 0.01 * check.output(0).mean());
  // What it says of itself is what is found.
  EXPECT_GT(form->quality.outputs[0].sigma_r, 0.5 * error);
  EXPECT_LT(form->quality.outputs[0].sigma_r, 2.0 * error);
}

// The first runs of a design with all the parameters of a building, as measures are fitted to.
TEST(MetaModel, MonthlyFormKnowsItsErrorWithFewRunsOfManyParameters) {
  const auto with_idle = [](int runs, std::uint64_t seed) {
    DesignData design = bent_design(runs, seed);
    Rng rng(seed);
    for (int extra = 0; extra < 13; ++extra) {
      design.parameters.push_back("idle" + std::to_string(extra));
      design.theta.conservativeResize(runs, design.theta.cols() + 1);
      for (double& x : design.theta.rightCols<1>().reshaped()) x = rng.uniform();
    }
    return design;
  };
  const DesignData check = with_idle(100, 2);
  const auto form = regression::fit_monthly_form(with_idle(40, 1));
  ASSERT_TRUE(form.has_value()) << form.error().message;
  const Eigen::MatrixXd predicted = predictions(*model_of(*form, check.months), check.theta);
  const double error = std::sqrt((predicted.leftCols(6) - check.output(0)).cwiseAbs2().mean());
  EXPECT_GT(form->quality.outputs[0].sigma_r, 0.6 * error);
}

TEST(MetaModel, OfTheMonthlyFormRefusesOtherMonths) {
  const auto form = regression::fit_monthly_form(regression::made_design(60, 6, 0.0));
  const std::vector<std::string> months{"2016-2", "2018-03"};
  const auto model = model_of(*form, months);
  ASSERT_FALSE(model.has_value());
  EXPECT_EQ(model.error().code, ErrorCode::not_found);
  EXPECT_EQ(
      model.error().message,
      "month 2018-03 is not in the design (2016-1 to 2016-6), and the monthly form says nothing "
      "about other months; use the seed's form for them");
}

GivenRegression given(std::vector<NamedCoefficient> terms) {
  return {std::move(terms), {"set_point", "air"}, {{20.0, 28.0}, {0.0, 2.0}},
          {"drybulb"},      {{-10.0, 30.0}},      {{100.0, 300.0}, {10.0, 20.0}}};
}

MonthInputs given_months() {
  return {{"drybulb"}, {"1", "2"}, (Eigen::MatrixXd(2, 1) << 0.0, 10.0).finished()};
}

// At set_point 24, air 1, second month: w = 0.5, s = 0.5, t = 0.5; out 0 and 1.
//   0.1 + 0.2 w + 0.3 out + 0.4 w s + 0.5 s t + 0.6 out t + 0.8 t^2
// = 0.1 + 0.1 + 0.1 + 0.125 + 0.2 = 0.625 for consumption, and 0.3 + 0.3 more for the peak.
TEST(MetaModel, OfGivenTermsByHand) {
  auto model = model_of(given({{"(Intercept)", 0.1},
                               {"drybulb", 0.2},
                               {"out", 0.3},
                               {"set_point:drybulb", 0.4},
                               {"set_point:air", 0.5},
                               {"out:air", 0.6},
                               {"air^2", 0.8}}),
                        given_months());
  ASSERT_TRUE(model.has_value()) << model.error().message;
  const std::vector<double> theta{24.0, 1.0};
  std::vector<double> outputs(4);
  model->evaluate(theta, outputs);
  EXPECT_NEAR(outputs[1], 100.0 + 200.0 * 0.625, 1e-12);
  EXPECT_NEAR(outputs[3], 10.0 + 10.0 * 1.225, 1e-12);
  EXPECT_NEAR(outputs[0], 100.0 + 200.0 * (0.625 - 0.05 - 0.05), 1e-12);  // w = 0.25
}

TEST(MetaModel, OfGivenTermsNamesWhatItDoesNotKnow) {
  const auto message = [](const std::string& term, double value = 1.0) {
    const auto model = model_of(given({{"drybulb", 1.0}, {term, value}}), given_months());
    return model ? std::string("no error") : model.error().message;
  };
  EXPECT_EQ(message("drybulb:sun"),
            "the term 'drybulb:sun' of the meta-model has an unknown factor 'sun'; known are "
            "drybulb, out, set_point, air");
  EXPECT_EQ(message("a:b:c"),
            "the term 'a:b:c' of the meta-model has more than two factors; only main effects, "
            "squares and products of two are understood");
  EXPECT_EQ(message("drybulb"), "the term 'drybulb' of the meta-model comes twice");
  EXPECT_EQ(message("air", std::nan("")),
            "the coefficient of 'air' in the meta-model is no number");
  EXPECT_EQ(message("air:"),
            "the term 'air:' of the meta-model has an unknown factor ''; known are drybulb, out, "
            "set_point, air");
  EXPECT_EQ(message("air"), "no error");
}

// The given coefficients came from R's step on this very design, scaled by priors, measured months
// and design; so they have to predict the design with R's in-sample R2 of 0.9683.
TEST(MetaModel, OfGivenTermsPredictsTheSeedcase) {
  const auto folder = recald::testing::own_data("seedcase");
  const DesignData design = regression::read_design(folder);
  std::vector<Parameter> parameters;
  auto rows = regression::read_table(folder / "priors.csv");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    parameters.push_back({rows[i][0],
                          rows[i][1],
                          {std::stod(rows[i][2]), std::stod(rows[i][3]), std::stod(rows[i][4])}});
  }
  GivenRegression regression{{},
                             design.parameters,
                             prior_scales(parameters),
                             design.inputs,
                             regression::column_scales(design.month_inputs),
                             regression::output_scales(design)};
  rows = regression::read_table(folder / "metamodel.csv");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    regression.terms.push_back({rows[i][0], std::stod(rows[i][1])});
  }
  const auto model = model_of(regression, inputs_of(design));
  ASSERT_TRUE(model.has_value()) << model.error().message;
  const Eigen::MatrixXd predicted = predictions(*model, design.theta);
  const Eigen::Index months = design.month_count();
  double residual = 0.0;
  Eigen::MatrixXd truth = design.values;
  for (Eigen::Index k = 0; k < 2; ++k) {
    const double range = regression.output_scales[static_cast<std::size_t>(k)].range();
    truth.middleCols(k * months, months).array() -=
        regression.output_scales[static_cast<std::size_t>(k)].min;
    truth.middleCols(k * months, months) /= range;
    residual += ((predicted - design.values).middleCols(k * months, months) / range).squaredNorm();
  }
  const double total = (truth.array() - truth.mean()).square().sum();
  EXPECT_NEAR(1.0 - residual / total, 0.9683, 0.0001);
}

}  // namespace
}  // namespace recald::model::metamodel
