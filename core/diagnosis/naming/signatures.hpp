/// What the meters of a building look like, in a few hundred numbers that each mean something.
///
/// The same numbers are taken of the measured and of the modelled hours, so that their difference
/// says where the two disagree: at night, on Saturdays, when it is humid, in the mornings of cold
/// days. All are linear in the power: means over groups of hours, and coefficients of regressions.
///
/// The model's lights and plugs are read off the electricity meter, so what plant uses at the same
/// hours all year is among them. Electricity is therefore read without its mean by kind of day and
/// hour.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/diagnosis/evidence/site_problem.hpp"

namespace recald::diagnosis {

/// The meters that signatures speak of. Gas and steam count as heat; of two meters of a kind the
/// first is taken. A meter that counts less than 2 % of all is left out.
enum class SignatureMeter { electricity, cooling, heat };
inline constexpr std::size_t kSignatureMeters = 3;
[[nodiscard]] std::string_view to_string(SignatureMeter meter);

/// The names of one meter's signatures, in order of their values: "workdays, when cold, 06 to 08
/// h".
[[nodiscard]] const std::vector<std::string>& signature_names();

/// The groups of hours and the regressions of a site, made once.
class SignatureReader {
 public:
  explicit SignatureReader(const SiteProblem& site);

  /// Whether signatures are taken of this meter: of each kind of energy they are of the first one,
  /// and of none that counts next to nothing. @param meter  Index among the site's.
  [[nodiscard]] bool reads(int meter) const;

  /// @param hours_kW  (hours x m) measured or modelled. Only hours that were measured count.
  /// @return (names x meters) powers in units of what was measured in the same hours plus a quarter
  ///         of the meter's mean, because models err by shares of what is there. The mean counts as
  ///         at least a twentieth of the sum of all meters' means. Slopes are per standard
  ///         deviation of what they are of. NaN where the site has no such meter, or too few such
  ///         hours.
  [[nodiscard]] Eigen::MatrixXd read(const Eigen::Ref<const Eigen::ArrayXXd>& hours_kW) const;

 private:
  friend class SpanReader;

  /// Hours that are alike, averaged by day and regressed on weather and date.
  struct Regime {
    std::vector<int> row_of_hour;  ///< (hours) day of the regime; -1: not in it.
    std::vector<double> per_hour;  ///< (rows) 1 / hours measured.
    Eigen::MatrixXd of_rows;       ///< (signatures x rows) what each is of the days' powers in kW.
  };
  struct Meter {
    int column = -1;  ///< In hours_kW; -1: there is none.
    double mean_kW = 1.0;
    std::vector<int> group;  ///< (hours) kind of day, season, two hours; -1: not measured.
    std::vector<double> per_group_kWh;  ///< (groups) 1 / (hours measured x unit); NaN: too few.
    std::vector<Regime> regimes;
    std::vector<double> darkness;     ///< (hours) weight of a kW in its kind of darkness …
    std::vector<int> dark_kind;       ///< … (hours) which is this; -1: none.
    std::vector<double> no_darkness;  ///< (kinds) 0; NaN where there are too few hours.
    std::vector<int> cell;            ///< (hours) kind of day and hour; empty: all power counts.
    /// (signatures x cells) what a kWh in one of a cell's hours takes from each by its mean.
    Eigen::MatrixXd of_cells;
  };
  [[nodiscard]] Meter make_meter(int column, double least_kW) const;
  /// The unit of powers at hours when so much was measured.
  [[nodiscard]] static double unit_at(const Meter& meter, double level_kW);
  [[nodiscard]] Regime make_regime(const Meter& meter, int kind) const;
  void make_darkness(Meter& meter) const;
  void make_cells(Meter& meter) const;
  /// Adds what the hours from one to another contribute to the signatures.
  void add(const Meter& meter, const double* kW, std::size_t from, std::size_t to,
           double* values) const;
  void add_power(const Meter& meter, const double* kW, std::size_t from, std::size_t to,
                 double* values) const;

  const SiteProblem* site_;
  std::array<Meter, kSignatureMeters> meters_;
  std::vector<int> hours_before_;  ///< (day index + 1) hours of the record before that day.
  std::vector<double> day_C_;      ///< (day index) mean outdoor temperature.
};

/// Signatures of a record that is like another one but for some days: an effect from a date on
/// costs no run of the model.
class SpanReader {
 public:
  /// @param base_kW  (hours x m); must outlive the reader.
  SpanReader(const SignatureReader& reader, const Eigen::ArrayXXd& base_kW);

  /// @param other_kW  (hours x m)
  void take(const Eigen::Ref<const Eigen::ArrayXXd>& other_kW);
  /// @return (names x meters) by how much signatures change if the days from `from_day` up to and
  ///         without `to_day` are those of the other record; NaN as in `SignatureReader::read`.
  [[nodiscard]] Eigen::MatrixXd change(int from_day, int to_day) const;

 private:
  const SignatureReader* reader_;
  const Eigen::ArrayXXd* base_kW_;
  Eigen::ArrayXXd more_kW_;
};

}  // namespace recald::diagnosis
