/// Alarms of a record, from the month that raises one until it is known what it comes from.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/calibration/hyper_prior.hpp"
#include "core/drift/cause.hpp"
#include "core/drift/daily_watches.hpp"
#include "core/drift/prequential.hpp"
#include "core/drift/site_drift.hpp"
#include "core/model/monthly_model.hpp"
#include "core/result.hpp"

namespace recald::drift {

struct InquiryOptions {
  CauseOptions causes;
  /// A cause as likely as this is acted upon: the model begins anew, or the meter is set aside.
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
            Prequential& prequential, DailyWatches& daily, const std::function<bool()>& proceed)
      : model_(model),
        prior_(prior),
        options_(options),
        seed_(seed),
        drift_(drift),
        prequential_(prequential),
        daily_(daily),
        proceed_(proceed) {}

  /// After a month was taken in. Days say first when something changed.
  /// @return or an error of the model or of sampling.
  [[nodiscard]] Result<void> look(const PrequentialMonth& month);

 private:
  struct Open {
    std::size_t alarm;
    std::vector<Eigen::VectorXd> before;
  };

  [[nodiscard]] Result<void> open(const Alarm& alarm, int month);
  [[nodiscard]] bool is_known(const Alarm& alarm) const;
  [[nodiscard]] ChangeCase case_of(const Alarm& alarm, int until) const;
  [[nodiscard]] const MeterChange* change_of_meter(const Alarm& alarm, int month) const;
  /// @return whether nothing more is to be asked.
  [[nodiscard]] Result<bool> weigh(const Open& open, int month);

  const MonthlyModel& model_;
  const calibration::HyperPrior& prior_;
  const InquiryOptions& options_;
  std::uint64_t seed_;
  SiteDrift& drift_;
  Prequential& prequential_;
  DailyWatches& daily_;
  const std::function<bool()>& proceed_;
  std::vector<Open> open_;
};

}  // namespace recald::drift
