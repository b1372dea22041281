/// Multiple tests: which of them count as findings.
#pragma once

#include <span>
#include <vector>

namespace recald::diagnosis {

/// Adjusted p-values under any dependence: a test is a finding at rate q if its value is <= q.
///
/// With p_(1) <= ... <= p_(m) and c = sum_{i<=m} 1/i, the i-th is  min_{j>=i} m c p_(j) / j, at
/// most 1. Controls the expected share of false findings among all findings.
/// @param p_values  In [0, 1]; may be empty. A NaN is a bug of the caller.
/// @see Benjamini, Yekutieli (2001), Ann. Statist. 29(4), theorem 1.3.
[[nodiscard]] std::vector<double> benjamini_yekutieli(std::span<const double> p_values);

/// Adjusted p-values that control the probability of any false finding; any dependence.
/// @see Holm (1979), Scand. J. Statist. 6(2).
[[nodiscard]] std::vector<double> holm(std::span<const double> p_values);

/// One family of tests: its bins, and one test of all of them together.
struct TestFamily {
  double omnibus_p;  ///< Of the largest |t| in the family.
  std::vector<double> bin_p_values;
};

/// Flags of the bins that are findings, family by family.
///
/// A family is opened by its omnibus test (Holm over families at `rate`); its bins are then tested
/// by Benjamini-Yekutieli at `rate`.
[[nodiscard]] std::vector<std::vector<bool>> findings(std::span<const TestFamily> families,
                                                      double rate = 0.05);

}  // namespace recald::diagnosis
