#include "core/regression/stepwise.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "core/regression/least_squares.hpp"
#include "core/regression/sweep.hpp"

namespace recald::regression {
namespace {

// R's `step` stops when the best neighbour is not better by this.
constexpr double kImprovement = 1e-7;
// Below this share of the total the residuals are rounding, and their logarithm means nothing.
constexpr double kExactFit = 1e-14;

/// The model on its way: which columns are in, and which may move.
class Search {
 public:
  Search(const CentredProducts& products, std::span<const Parents> parents,
         const StepwiseOptions& options)
      : products_(products),
        parents_(parents),
        options_(options),
        swept_(products),
        children_in_(parents.size(), 0),
        exact_(kExactFit * products.yy.sum()) {
    const double rows_left = std::max(products.rows - 2.0, 0.0);
    terms_max_ = static_cast<int>(rows_left);
    if (options.terms_max > 0) terms_max_ = std::min(terms_max_, options.terms_max);
  }

  /// Brings in those of the columns that others do not determine.
  void start_from(std::span<const int> columns) {
    for (const int j : columns) {
      if (may_come(j)) {
        toggle(j);
      } else {
        aliased_.push_back(j);
      }
    }
  }

  /// Takes the best step; false when there is none.
  bool step() {
    const double current = criterion(swept_.residual_squares_sum(), swept_.swept_count());
    double best = current - kImprovement;
    int column = -1;
    const auto consider = [&](int j, int terms) {
      const double after = swept_.residual_squares_sum() + swept_.toggle_change(j);
      const double value = criterion(after, terms);
      if (value < best) {
        best = value;
        column = j;
      }
    };
    for (int j = 0; j < count(); ++j) {
      if (swept_.swept(j)) {
        if (children_in_[index(j)] == 0) consider(j, swept_.swept_count() - 1);
      } else if (may_come(j)) {
        consider(j, swept_.swept_count() + 1);
      }
    }
    if (column < 0) return false;
    toggle(column);
    return true;
  }

  Result<StepwiseFit> result(int steps) {
    StepwiseFit fit;
    for (int j = 0; j < count(); ++j) {
      if (swept_.swept(j)) fit.columns.push_back(j);
    }
    auto solved = TRY(fit_least_squares(products_, fit.columns));
    fit.coefficients = std::move(solved.coefficients);
    fit.intercepts = std::move(solved.intercepts);
    fit.residual_squares = std::move(solved.residual_squares);
    fit.criterion = criterion(fit.residual_squares.sum(), static_cast<int>(fit.columns.size()));
    fit.steps = steps;
    fit.aliased = std::move(aliased_);
    return fit;
  }

 private:
  static std::size_t index(int j) { return static_cast<std::size_t>(j); }
  [[nodiscard]] int count() const { return static_cast<int>(parents_.size()); }

  [[nodiscard]] bool may_come(int j) const {
    for (const int parent : parents_[index(j)]) {
      if (parent >= 0 && !swept_.swept(parent)) return false;
    }
    return swept_.swept_count() < terms_max_ && swept_.free_share(j) > options_.tolerance;
  }

  void toggle(int j) {
    swept_.toggle(j);
    const int change = swept_.swept(j) ? 1 : -1;
    for (const int parent : parents_[index(j)]) {
      if (parent >= 0) children_in_[index(parent)] += change;
    }
  }

  [[nodiscard]] double criterion(double residual_squares, int terms) const {
    const auto responses = static_cast<double>(products_.yy.size());
    return information_criterion(options_.criterion, std::max(residual_squares, exact_),
                                 products_.rows, responses, terms);
  }

  const CentredProducts& products_;
  std::span<const Parents> parents_;
  const StepwiseOptions& options_;
  SweptProducts swept_;
  std::vector<int> children_in_;  ///< How many terms in the model need this one.
  std::vector<int> aliased_;
  double exact_;
  int terms_max_;
};

std::vector<int> start_columns(std::size_t count, const StepwiseOptions& options) {
  if (options.start == StepwiseOptions::Start::given) return options.given_columns;
  std::vector<int> columns;
  if (options.start == StepwiseOptions::Start::full) {
    columns.resize(count);
    std::iota(columns.begin(), columns.end(), 0);
  }
  return columns;
}

StepwiseFit intercepts_only(const CentredProducts& products) {
  StepwiseFit fit;
  fit.coefficients.resize(0, products.y_mean.size());
  fit.intercepts = products.y_mean;
  fit.residual_squares = products.yy;
  fit.criterion = -std::numeric_limits<double>::infinity();
  fit.steps = 0;
  return fit;
}

}  // namespace

double information_criterion(Criterion criterion, double residual_squares, double rows,
                             double responses, int terms) {
  const double cells = rows * responses;
  const double fit = cells * std::log(residual_squares / cells);
  const double coefficients = terms + 1.0;
  switch (criterion) {
    case Criterion::aic:
      return fit + 2.0 * responses * coefficients;
    case Criterion::bic:
      return fit + std::log(cells) * responses * coefficients;
    case Criterion::aic_corrected: {
      const double k = coefficients + 1.0;  // the residual variance is a parameter, too
      const double left = rows - k - 1.0;
      if (left <= 0.0) return std::numeric_limits<double>::infinity();
      return fit + responses * (2.0 * coefficients + 2.0 * k * (k + 1.0) / left);
    }
  }
  assert(false && "all criteria are handled");
  return fit;
}

Result<StepwiseFit> stepwise(const CentredProducts& products, std::span<const Parents> parents,
                             const StepwiseOptions& options) {
  assert(static_cast<Eigen::Index>(parents.size()) == products.xx.cols());
  if (!products.xx.allFinite() || !products.xy.allFinite() || !products.yy.allFinite()) {
    return failure(ErrorCode::not_finite,
                   "a value of the regression is missing or infinite; check the design's inputs "
                   "and outputs");
  }
  const std::vector<int> start = start_columns(parents.size(), options);
  if (products.rows < static_cast<double>(start.size()) + 2.0 && !start.empty()) {
    return failure(ErrorCode::not_enough_data,
                   "a regression that starts with " + std::to_string(start.size()) +
                       " terms needs at least " + std::to_string(start.size() + 2) +
                       " rows, but there are " + std::to_string(static_cast<long>(products.rows)) +
                       "; start from the empty model or add runs");
  }
  // Rounding in a product of values near 1 makes a constant response look like 1e-16 of spread.
  const double level = products.rows * products.y_mean.squaredNorm();
  if (products.yy.sum() <= kExactFit * level) return intercepts_only(products);

  Search search(products, parents, options);
  search.start_from(start);
  int steps = 0;
  while (steps < options.steps_max && search.step()) ++steps;
  return search.result(steps);
}

}  // namespace recald::regression
