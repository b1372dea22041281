/// A store that refuses when a test says so, in front of a real one.
#pragma once

#include <utility>

#include "adapters/ports/store.hpp"

namespace recald::testing {

class FailingStore final : public Store {
 public:
  explicit FailingStore(Store& behind) : behind_(behind) {}

  bool refuses = false;
  /// Told of each batch before it is committed, and after it was.
  std::function<void(const StoreBatch&)> before_commit;
  std::function<void(const StoreBatch&)> after_commit;

  Result<std::uint32_t> meter_number(const std::string& id,
                                     std::chrono::seconds interval) override {
    if (refuses) return refusal();
    return behind_.meter_number(id, interval);
  }
  Result<std::optional<std::uint32_t>> find_meter(const std::string& id) override {
    if (refuses) return refusal();
    return behind_.find_meter(id);
  }
  Result<CommitCounts> commit(const StoreBatch& batch) override {
    if (refuses) return refusal();
    if (before_commit) before_commit(batch);
    auto counts = behind_.commit(batch);
    if (counts && after_commit) after_commit(batch);
    return counts;
  }
  void on_refusal(std::function<bool()> make_room) override {
    behind_.on_refusal(std::move(make_room));
  }
  Result<void> as_one(const std::function<Result<void>()>& work) override {
    if (refuses) return refusal();
    return behind_.as_one(work);
  }
  Result<void> for_each_interval(std::uint32_t meter, const metering::TimeSpan& span,
                                 const std::function<void(const StoredInterval&)>& visit) override {
    if (refuses) return refusal();
    return behind_.for_each_interval(meter, span, visit);
  }
  Result<std::string> closing_rules(std::uint32_t meter) override {
    if (refuses) return refusal();
    return behind_.closing_rules(meter);
  }
  Result<int> put_closing_rules(std::uint32_t meter, const std::string& rules) override {
    if (refuses) return refusal();
    return behind_.put_closing_rules(meter, rules);
  }
  Result<std::optional<metering::TimeSpan>> interval_extent(std::uint32_t meter) override {
    if (refuses) return refusal();
    return behind_.interval_extent(meter);
  }
  Result<bool> was_read_in(const metering::TimeSpan& span) override {
    if (refuses) return refusal();
    return behind_.was_read_in(span);
  }
  Result<std::vector<RegisterState>> registers(std::uint32_t meter) override {
    if (refuses) return refusal();
    return behind_.registers(meter);
  }
  Result<void> for_each_sample(
      std::uint32_t meter, const std::string& field,
      const std::function<void(const metering::RegisterSample&)>& visit) override {
    if (refuses) return refusal();
    return behind_.for_each_sample(meter, field, visit);
  }
  Result<int> delete_samples(metering::Instant keep_from, int rows_max) override {
    if (refuses) return refusal();
    return behind_.delete_samples(keep_from, rows_max);
  }
  Result<std::int64_t> add_edit(const StoreEdit& edit) override {
    if (refuses) return refusal();
    return behind_.add_edit(edit);
  }
  Result<void> remove_edit(std::int64_t number) override {
    if (refuses) return refusal();
    return behind_.remove_edit(number);
  }
  Result<std::set<metering::Instant>> edited_days(std::uint32_t meter) override {
    if (refuses) return refusal();
    return behind_.edited_days(meter);
  }
  Result<std::vector<MeterMonth>> reopened() override {
    if (refuses) return refusal();
    return behind_.reopened();
  }
  Result<int> put_month(std::uint32_t meter, const metering::MonthlyFigure& figure,
                        const std::string& time_zone_release, metering::Instant now) override {
    if (refuses) return refusal();
    return behind_.put_month(meter, figure, time_zone_release, now);
  }
  Result<std::vector<StoredMonth>> months(std::uint32_t meter) override {
    if (refuses) return refusal();
    return behind_.months(meter);
  }
  Result<std::vector<StoreEvent>> events_after(std::int64_t number, int limit) override {
    if (refuses) return refusal();
    return behind_.events_after(number, limit);
  }
  Result<std::optional<std::int64_t>> cursor(const std::string& destination) override {
    if (refuses) return refusal();
    return behind_.cursor(destination);
  }
  Result<void> put_cursor(const std::string& destination, std::int64_t position) override {
    if (refuses) return refusal();
    return behind_.put_cursor(destination, position);
  }
  Result<void> keep_outbox_for(const std::vector<std::string>& destinations) override {
    if (refuses) return refusal();
    return behind_.keep_outbox_for(destinations);
  }
  Result<std::vector<OutboxEntry>> outbox_after(std::int64_t number, int limit) override {
    if (refuses) return refusal();
    return behind_.outbox_after(number, limit);
  }
  Result<OutboxPosition> outbox_position(const std::string& destination) override {
    if (refuses) return refusal();
    return behind_.outbox_position(destination);
  }
  Result<void> put_outbox_position(const std::string& destination, std::int64_t number) override {
    if (refuses) return refusal();
    return behind_.put_outbox_position(destination, number);
  }
  Result<std::vector<StoreEvent>> events(int limit) override {
    if (refuses) return refusal();
    return behind_.events(limit);
  }
  Result<void> for_each_event(metering::Instant until,
                              const std::function<bool(const StoreEvent&)>& visit) override {
    if (refuses) return refusal();
    return behind_.for_each_event(until, visit);
  }
  Result<std::set<std::string>> silent_meters() override {
    if (refuses) return refusal();
    return behind_.silent_meters();
  }
  Result<std::int64_t> add_job(const StoredJob& job) override {
    if (refuses) return refusal();
    return behind_.add_job(job);
  }
  Result<void> put_job(const StoredJob& job) override {
    if (refuses) return refusal();
    return behind_.put_job(job);
  }
  Result<std::optional<StoredJob>> job(std::int64_t number) override {
    if (refuses) return refusal();
    return behind_.job(number);
  }
  Result<std::vector<StoredJob>> jobs(JobKind kind, int limit) override {
    if (refuses) return refusal();
    return behind_.jobs(kind, limit);
  }
  Result<int> delete_events(metering::Instant keep_from, int rows_max) override {
    if (refuses) return refusal();
    return behind_.delete_events(keep_from, rows_max);
  }
  Result<std::optional<StoredJob>> oldest_job_beyond(JobKind kind, int kept) override {
    if (refuses) return refusal();
    return behind_.oldest_job_beyond(kind, kept);
  }
  Result<void> delete_job(std::int64_t number) override {
    if (refuses) return refusal();
    return behind_.delete_job(number);
  }
  Result<std::optional<StoredJob>> last_accepted(JobKind kind) override {
    if (refuses) return refusal();
    return behind_.last_accepted(kind);
  }
  Result<std::vector<StoredJob>> unfinished_jobs() override {
    if (refuses) return refusal();
    return behind_.unfinished_jobs();
  }
  Result<void> add_forecasts(std::span<const StoredForecast> forecasts) override {
    if (refuses) return refusal();
    return behind_.add_forecasts(forecasts);
  }
  Result<std::vector<StoredForecast>> forecasts() override {
    if (refuses) return refusal();
    return behind_.forecasts();
  }
  Result<StoreCheck> check() override {
    if (refuses) return refusal();
    return behind_.check();
  }
  Result<std::unique_ptr<StoreBackup>> begin_backup(const std::filesystem::path& file) override {
    if (refuses) return refusal();
    return behind_.begin_backup(file);
  }

 private:
  static tl::unexpected<Error> refusal() {
    return failure(ErrorCode::io_failed, "database or disk is full");
  }

  Store& behind_;
};

}  // namespace recald::testing
