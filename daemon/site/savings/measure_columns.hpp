/// Where measures change an EnergyPlus model: in its parameters, or in columns beside them.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/model/parameter.hpp"
#include "core/savings/measure.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// Each measure by itself and, where there are several, all of them.
[[nodiscard]] std::vector<std::span<const savings::Measure>> alone_and_together(
    const std::vector<savings::Measure>& measures);

/// The changes of some measures, carried out one after the other.
///
/// A row of their design has the model's parameters, and behind them the extents that are not
/// known. A row of the engine has the parameters, changed, and behind them the columns beside.
class MeasureColumns {
 public:
  MeasureColumns(const ModelConfig& model, std::span<const savings::Measure> measures);

  [[nodiscard]] const std::vector<savings::Change>& changes() const { return changes_; }

  /// What is no parameter of the model: each name of the library once, and each change by targets.
  [[nodiscard]] const std::vector<ParameterConfig>& beside() const { return beside_; }

  /// The extents that are not known, in the order of the changes.
  [[nodiscard]] const std::vector<Parameter>& extents() const { return extents_; }

  /// @param theta    (rows x parameters + extents)
  /// @param designs  (parameters + beside) What the model has of each column.
  /// @return (rows x parameters + beside)
  [[nodiscard]] Eigen::MatrixXd changed(const Eigen::MatrixXd& theta,
                                        std::span<const double> designs) const;

 private:
  Eigen::Index parameters_;
  std::vector<savings::Change> changes_;
  std::vector<Eigen::Index> column_of_;  ///< (changes) Of the engine.
  std::vector<ParameterConfig> beside_;
  std::vector<Parameter> extents_;
};

}  // namespace recald::daemon
