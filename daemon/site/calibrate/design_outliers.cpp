#include "daemon/site/calibrate/design_outliers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "core/regression/outlying_runs.hpp"
#include "core/text/number_text.hpp"
#include "daemon/site/calibrate/design_metamodel.hpp"

namespace recald::daemon {
namespace {

constexpr std::size_t kNamedMax = 5;
constexpr std::size_t kAccidentsPerRun = 10;  // one run in ten

std::string where(const doe::DesignFolder& design, const regression::OutlyingRun& out) {
  return fmt::format("{} in {} is {}, where the median of all runs is {}",
                     design.output_names[static_cast<std::size_t>(out.output)],
                     design.months[static_cast<std::size_t>(out.month)].text(),
                     number_text(out.value), number_text(out.median));
}

void remove(const std::vector<regression::OutlyingRun>& outliers, doe::DesignFolder& design) {
  std::vector<Eigen::Index> kept;
  std::vector<int> ids;
  for (Eigen::Index row = 0; row < design.theta.rows(); ++row) {
    if (std::ranges::find(outliers, row, &regression::OutlyingRun::run) != outliers.end()) continue;
    kept.push_back(row);
    ids.push_back(design.runs[static_cast<std::size_t>(row)]);
  }
  design.runs = std::move(ids);
  design.theta = design.theta(kept, Eigen::all).eval();
  design.outputs = design.outputs(kept, Eigen::all).eval();
}

}  // namespace

std::vector<std::string> set_aside_outliers(doe::DesignFolder& design) {
  auto outliers = regression::outlying_runs(design_data(design));
  if (outliers.empty()) return {};
  std::ranges::stable_sort(outliers, std::greater{}, &regression::OutlyingRun::reach);
  const auto id = [&](const regression::OutlyingRun& out) {
    return design.runs[static_cast<std::size_t>(out.run)];
  };
  if (outliers.size() * kAccidentsPerRun > design.runs.size()) {
    return {fmt::format(
        "{} of {} runs stand far from the others (run {}: {}); so many are no accident, and all "
        "stay in the design. Check the simulator and the priors.",
        outliers.size(), design.runs.size(), id(outliers.front()),
        where(design, outliers.front()))};
  }
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < std::min(kNamedMax, outliers.size()); ++i) {
    notes.push_back(fmt::format("Run {} is left out: {}. Check that run of the simulator.",
                                id(outliers[i]), where(design, outliers[i])));
  }
  if (outliers.size() > kNamedMax) {
    notes.push_back(
        fmt::format("{} more runs are left out for the same reason.", outliers.size() - kNamedMax));
  }
  remove(outliers, design);
  return notes;
}

}  // namespace recald::daemon
