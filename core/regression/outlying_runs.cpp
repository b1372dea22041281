#include "core/regression/outlying_runs.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/statistics/quantile.hpp"

namespace recald::regression {
namespace {

/// The runs of one output in one month.
struct Column {
  double median;
  double lower;  ///< Quartile.
  double upper;  ///< Quartile.

  [[nodiscard]] double range() const { return upper - lower; }
  /// Beyond the quartiles; 0 between them.
  [[nodiscard]] double beyond(double value) const {
    return std::max({value - upper, lower - value, 0.0});
  }
};

Column column_of(Eigen::VectorXd values) {
  std::sort(values.begin(), values.end());
  return {quantile_of_sorted(values, 0.5), quantile_of_sorted(values, 0.25),
          quantile_of_sorted(values, 0.75)};
}

/// Runs of one column that are out, each entered where it stands out most.
class ColumnSearch {
 public:
  ColumnSearch(const OutlierOptions& options, std::map<Eigen::Index, OutlyingRun>& found)
      : options_(options), found_(found) {}

  /// @param width  What counts as the column's quartile range.
  void run(const Eigen::Ref<const Eigen::VectorXd>& values, const Column& column, double width,
           Eigen::Index output, Eigen::Index month) {
    double low = column.lower;
    double high = column.upper;
    for (const double value : values) {
      if (column.beyond(value) > options_.fence * width) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const double reach = column.beyond(values[i]) / width;
      const double gap = std::max(values[i] - high, low - values[i]) / width;
      if (reach <= options_.fence || gap < options_.gap) continue;
      const OutlyingRun out{i, output, month, values[i], column.median, reach};
      const auto [place, is_new] = found_.emplace(i, out);
      if (!is_new && place->second.reach < reach) place->second = out;
    }
  }

 private:
  const OutlierOptions& options_;
  std::map<Eigen::Index, OutlyingRun>& found_;
};

}  // namespace

std::vector<OutlyingRun> outlying_runs(const DesignData& design, const OutlierOptions& options) {
  std::map<Eigen::Index, OutlyingRun> found;
  if (design.runs() < options.runs_min || !design.values.allFinite()) return {};
  ColumnSearch search{options, found};
  for (Eigen::Index k = 0; k < std::ssize(design.outputs); ++k) {
    std::vector<Column> columns;
    double widest = 0.0;
    for (Eigen::Index m = 0; m < design.month_count(); ++m) {
      columns.push_back(column_of(design.output(k).col(m)));
      widest = std::max(widest, columns.back().range());
    }
    if (widest <= 0.0) continue;  // nothing is far from anything
    for (Eigen::Index m = 0; m < design.month_count(); ++m) {
      const Column& column = columns[static_cast<std::size_t>(m)];
      search.run(design.output(k).col(m), column,
                 std::max(column.range(), options.widest_share * widest), k, m);
    }
  }
  std::vector<OutlyingRun> runs;
  for (const auto& [row, run] : found) runs.push_back(run);
  return runs;
}

}  // namespace recald::regression
