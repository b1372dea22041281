#include "daemon/site/calibrate/design_plan.hpp"

#include <algorithm>
#include <vector>

#include "core/random/streams.hpp"

namespace recald::daemon {
namespace {

std::vector<doe::DesignMonth> design_months(std::span<const std::string> names) {
  std::vector<doe::DesignMonth> months;
  for (const std::string& name : names) months.push_back(*doe::DesignMonth::parse(name));
  return months;
}

/// A table's months ascend; a site's come calibration first, and validation may lie before.
doe::MonthlyTable in_order_of_time(doe::MonthlyTable table) {
  std::vector<Eigen::Index> order(table.months.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Eigen::Index>(i);
  const auto month = [&](Eigen::Index row) { return table.months[static_cast<std::size_t>(row)]; };
  std::ranges::sort(order, {}, month);
  doe::MonthlyTable sorted{{}, table.names, table.values(order, Eigen::all)};
  for (const Eigen::Index row : order) sorted.months.push_back(month(row));
  return sorted;
}

}  // namespace

doe::MonthlyTable measured_table(const PreparedSite& site) {
  const SiteCalibration& so_far = site.so_far;
  doe::MonthlyTable table;
  table.months = design_months(so_far.month_names);
  table.values.resize(static_cast<Eigen::Index>(table.months.size()),
                      static_cast<Eigen::Index>(so_far.outputs.size()));
  for (std::size_t k = 0; k < so_far.outputs.size(); ++k) {
    table.names.push_back(so_far.outputs[k].name);
    table.values.col(static_cast<Eigen::Index>(k)) =
        Eigen::Map<const Eigen::VectorXd>(so_far.outputs[k].measured.data(), table.values.rows());
  }
  return in_order_of_time(std::move(table));
}

doe::DesignPlan plan_design(const PreparedSite& site, const SiteDesignOptions& options) {
  const SiteCalibration& so_far = site.so_far;
  doe::DesignPlan plan;
  plan.parameters = so_far.parameters;
  // Runs to check a design with are never its own.
  Rng rng{options.seed, streams::kHypercube[options.points == design::Points::wide ? 0 : 1]};
  plan.theta = design::draw_points(options.points, plan.parameters, options.runs, rng);
  for (const assessment::OutputCalibration& output : so_far.outputs)
    plan.output_names.push_back(output.name);
  const std::vector<doe::DesignMonth> months = design_months(so_far.month_names);
  plan.months = design_months(site.problem.month_names);
  plan.inputs = in_order_of_time({months, site.inputs.names, site.inputs.values});
  plan.measurements = measured_table(site);
  plan.seed = options.seed;
  plan.fingerprint = options.fingerprint;
  return plan;
}

engines::BuiltInEngine site_engine(const PreparedSite& site) {
  return {site.model->clone(), site.so_far.parameters};
}

}  // namespace recald::daemon
