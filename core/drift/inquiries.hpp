/// Alarms of a record, from the month that raises one until it is known what it comes from.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/calibration/covariance/hyper_prior.hpp"
#include "core/drift/cause.hpp"
#include "core/drift/named_change.hpp"
#include "core/drift/prequential.hpp"
#include "core/drift/site_drift.hpp"
#include "core/drift/watch/daily_watches.hpp"
#include "core/model/monthly_model.hpp"
#include "core/result.hpp"

namespace recald::drift {

struct InquiryOptions {
  CauseOptions causes;
  /// A meter as likely as this to be wrong is set aside; where it is as likely that the building
  /// has changed, in whatever, the model begins anew.
  double act_at = 0.8;
  /// A season shows one meter alone: causes are weighed again with each month, acted upon after so
  /// many, and left open after a year.
  int months_to_act = 4;
};

/// Looks into alarms and acts on what they come from.
class Inquiries {
 public:
  /// @param drift  Has months, outputs, parameters, directions and what is seen of meters; its
  ///               alarms are filled here.
  Inquiries(const MonthlyModel& model, const calibration::HyperPrior& prior,
            const InquiryOptions& options, std::uint64_t seed, SiteDrift& drift,
            Prequential& prequential, DailyWatches& daily, const AskHours& ask_hours,
            const std::function<bool()>& proceed)
      : model_(model),
        prior_(prior),
        options_(options),
        seed_(seed),
        drift_(drift),
        prequential_(prequential),
        daily_(daily),
        ask_hours_(ask_hours),
        proceed_(proceed) {}

  /// After a month was taken in. Days say first when something changed.
  /// @return or an error of the model or of sampling.
  [[nodiscard]] Result<void> evaluate(const PrequentialMonth& month);

 private:
  struct Open {
    std::size_t alarm;
    std::vector<Eigen::VectorXd> before;
    std::optional<NamedChange> names;  ///< As the hours said when something could be done.
    bool is_asked = false;
  };

  [[nodiscard]] Result<void> open(const Alarm& alarm, int month);
  [[nodiscard]] bool is_known(const Alarm& alarm) const;
  [[nodiscard]] ChangeCase case_of(const Alarm& alarm, int until) const;
  [[nodiscard]] const MeterChange* change_of_meter(const Alarm& alarm, int month) const;
  /// @return whether nothing more is to be asked.
  [[nodiscard]] Result<bool> weigh(Open& open, int month);
  void ask_hours(Open& open, int month);
  /// In the newest month an alarm that stays open says what the hours say now.
  void name_newest(ExplainedAlarm& alarm, std::vector<Cause> causes, int month);

  const MonthlyModel& model_;
  const calibration::HyperPrior& prior_;
  const InquiryOptions& options_;
  std::uint64_t seed_;
  SiteDrift& drift_;
  Prequential& prequential_;
  DailyWatches& daily_;
  const AskHours& ask_hours_;
  const std::function<bool()>& proceed_;
  std::vector<Open> open_;
};

}  // namespace recald::drift
