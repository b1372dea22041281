/// What the meters of a building look like, in a few hundred numbers that each mean something.
///
/// The same numbers are taken of the measured and of the modelled hours, so that their difference
/// says where the two disagree: at night, on Saturdays, when it is humid, in the mornings of cold
/// days. Nearly all are linear in the power: means over groups of hours, and coefficients of
/// regressions.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/diagnosis/site_problem.hpp"

namespace recald::diagnosis {

/// The meters that signatures speak of. Gas and steam count as heat; of two meters of a kind the
/// first is taken.
enum class SignatureMeter { electricity, cooling, heat };
inline constexpr std::size_t kSignatureMeters = 3;
[[nodiscard]] std::string_view to_string(SignatureMeter meter);

/// The names of one meter's signatures, in order of their values: "workday, cold, 06 to 08 h".
[[nodiscard]] const std::vector<std::string>& signature_names();

/// The groups of hours and the regressions of a site, made once.
class SignatureReader {
 public:
  explicit SignatureReader(const SiteProblem& site);

  /// @param hours_kW  (hours x m) measured or modelled. Only hours that were measured count.
  /// @return (names x meters) powers in units of the meter's measured mean, times in hours, shares
  ///         of one; NaN where the site has no such meter, or too few such hours.
  [[nodiscard]] Eigen::MatrixXd read(const Eigen::Ref<const Eigen::ArrayXXd>& hours_kW) const;

 private:
  /// Hours that are alike, averaged by day and regressed on weather and date.
  struct Regime {
    std::vector<int> row_of_hour;  ///< (hours) day of the regime; -1: not in it.
    std::vector<double> per_hour;  ///< (rows) 1 / hours measured.
    Eigen::MatrixXd solve;         ///< (coefficients x rows) least squares with a small ridge.
    Eigen::MatrixXd design;        ///< (rows x coefficients)
    std::vector<int> block;        ///< (rows) twelfth of the record.
    std::vector<int> weekday;      ///< (rows) 0…4 Monday to Friday of a working day; else -1.
    std::vector<int> month;        ///< (rows) 0…11
    std::vector<bool> free_day;    ///< (rows) a holiday from Monday to Friday.
    std::vector<int> warmth;       ///< (rows) bin of outdoor temperature.
  };
  struct Meter {
    int column = -1;         ///< In hours_kW; -1: there is none.
    double mean_kW = 0.0;    ///< Measured.
    std::vector<int> group;  ///< (hours) kind of day, season, two hours; -1: not measured.
    std::vector<Regime> regimes;
  };
  class Sheet;

  [[nodiscard]] Meter make_meter(int column) const;
  [[nodiscard]] Regime make_regime(const Meter& meter, int kind) const;
  void read_means(const Meter& meter, const double* kW, Sheet& sheet) const;
  void read_regime(const Regime& regime, const double* kW, double mean_kW, Sheet& sheet) const;
  void read_edges(const Meter& meter, const double* kW, Sheet& sheet) const;
  void read_darkness(const Meter& meter, const double* kW, Sheet& sheet) const;

  const SiteProblem* site_;
  std::array<Meter, kSignatureMeters> meters_;
  std::vector<int> first_hour_;    ///< (days) of each day that has all its hours.
  std::vector<double> day_C_;      ///< (day index) mean outdoor temperature.
  std::vector<double> morning_C_;  ///< (days of first_hour_) mean of 5 to 8 h.
};

}  // namespace recald::diagnosis
