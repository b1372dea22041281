#include "daemon/gateway/upkeep/upkeep.hpp"

#include <algorithm>
#include <utility>

#include "adapters/system/files/write_file.hpp"
#include "daemon/gateway/upkeep/backups.hpp"
#include "daemon/gateway/upkeep/job_folder.hpp"
#include "daemon/gateway/upkeep/open_store.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using std::chrono::milliseconds;

constexpr milliseconds kRest = std::chrono::hours{1};

/// Age is measured with a clock that readings have followed for a week. Otherwise, a clock set
/// years ahead for an hour would make everything look old at once.
metering::TimeSpan followed_until(Instant now) {
  return {now - std::chrono::days{21}, now - std::chrono::days{7}};
}

}  // namespace

Upkeep::Upkeep(Store& store, Worker& checker, StoreConfig config, metering::LocalCalendar calendar,
               std::function<void(StoreEvent)> report, const UpkeepRules& rules)
    : store_(store),
      checker_(checker),
      config_(std::move(config)),
      calendar_(std::move(calendar)),
      notify_(std::move(report)),
      rules_(rules),
      reserve_(
          std::make_shared<system::ReservedSpace>(reserve_file(config_), rules.reserve_bytes)) {
  store_.on_refusal([reserve = reserve_] { return reserve->give_up(); });
}

Upkeep::~Upkeep() { stop_.request_stop(); }

milliseconds Upkeep::maintain(Instant now, bool is_clock_right) {
  hold_reserve(now);
  const auto backed_up = back_up(now, is_clock_right);
  if (!backed_up) {
    backup_.reset();
    report(now, backup_failure_, "backup_failed", backed_up.error().message);
  } else if (*backed_up == Progress::more) {
    return rules_.pause;
  }
  const auto deleted = delete_old(now);
  if (!deleted) {
    report(now, deleting_failure_, "old_not_deleted", deleted.error().message);
  } else if (*deleted == Progress::more) {
    return rules_.pause;
  }
  return until_next(now);
}

void Upkeep::hold_reserve(Instant now) {
  if (auto held = reserve_->hold(); !held) {
    report(now, reserve_failure_, "no_reserve", held.error().message);
  } else {
    reserve_failure_.clear();
  }
}

Result<Upkeep::Progress> Upkeep::back_up(Instant now, bool is_clock_right) {
  if (is_checking_) return Progress::done;
  if (!backup_) return is_clock_right ? begin_backup(now) : Progress::done;
  const auto is_whole = TRY(backup_->step(rules_.backup_pages));
  if (!is_whole) return Progress::more;
  check_backup(now);
  return Progress::done;
}

void Upkeep::check_backup(Instant now) {
  is_checking_ = true;
  auto damage = std::make_shared<Result<std::string>>();
  checker_.run(
      [backup = backup_, stop = stop_.get_token(), damage] { *damage = backup->check(stop); },
      alive_.guard([this, damage, now] { end_backup(*damage, now); }));
}

void Upkeep::end_backup(const Result<std::string>& damage, Instant now) {
  is_checking_ = false;
  const auto backup = std::exchange(backup_, nullptr);
  if (damage && !damage->empty()) {
    damaged_on_ = calendar_.local_time(now).date;
    report(now, backup_failure_, "store_damaged",
           "the store is damaged, as a check of its copy shows (" + *damage +
               "); the copy was deleted, and earlier backups are kept. Restart recald: it recovers "
               "the rows that can be read",
           Severity::error);
    return;
  }
  const auto kept = damage ? backup->keep() : tl::unexpected(damage.error());
  if (!kept) {
    report(now, backup_failure_, "backup_failed", kept.error().message);
    return;
  }
  backup_failure_.clear();
  for (const std::filesystem::path& file : prune_backups(config_)) {
    report(now, backup_failure_, "backup_failed", "'" + file.string() + "' cannot be deleted");
  }
}

/// Today's backup is due once its time has come; the folder shows whether it was made.
Result<Upkeep::Progress> Upkeep::begin_backup(Instant now) {
  const auto today = calendar_.local_time(now).date;
  if (!config_.backup_at || damaged_on_ == today) return Progress::done;
  if (now < calendar_.first_instant(today, static_cast<int>(config_.backup_at->count()))) {
    return Progress::done;
  }
  const std::filesystem::path file = backup_file(config_, today);
  if (std::error_code unreadable; std::filesystem::exists(file, unreadable)) return Progress::done;
  TRY(system::make_folder(config_.backup_folder));
  backup_ = TRY(store_.begin_backup(file));
  return Progress::more;
}

Result<Upkeep::Progress> Upkeep::delete_old(Instant now) {
  const auto is_followed = TRY(store_.was_read_in(followed_until(now)));
  const auto aged = is_followed ? delete_aged(now) : Result<Progress>{Progress::done};
  if (!aged || *aged == Progress::more) return aged;
  for (const JobKind kind : {JobKind::calibration, JobKind::diagnosis}) {
    const auto results = delete_results(kind);
    if (!results || *results == Progress::more) return results;
  }
  deleting_failure_.clear();
  return Progress::done;
}

Result<Upkeep::Progress> Upkeep::delete_aged(Instant now) {
  const auto samples = TRY(store_.delete_samples(now - config_.raw_kept, rules_.rows));
  if (samples == rules_.rows) return Progress::more;
  const auto events = TRY(store_.delete_events(now - config_.events_kept, rules_.rows));
  return events == rules_.rows ? Progress::more : Progress::done;
}

/// Deletes one at a time, its files first: if killed in between, the job is still known and
/// gets its turn again.
Result<Upkeep::Progress> Upkeep::delete_results(JobKind kind) {
  const auto job = TRY(store_.oldest_job_beyond(kind, config_.results_kept));
  if (!job) return Progress::done;
  const std::filesystem::path folder = job_folder(config_, kind, job->number);
  std::error_code error;
  std::filesystem::remove_all(folder, error);
  if (error) {
    return failure(ErrorCode::io_failed,
                   "folder '" + folder.string() + "' cannot be deleted: " + error.message());
  }
  TRY(store_.delete_job(job->number));
  return Progress::more;
}

milliseconds Upkeep::until_next(Instant now) const {
  if (!config_.backup_at) return kRest;
  const auto minute = static_cast<int>(config_.backup_at->count());
  const Instant due = calendar_.first_instant(calendar_.local_time(now).date, minute);
  return due > now ? std::min<milliseconds>(kRest, due - now) : kRest;
}

/// The same failure hour after hour is one event.
void Upkeep::report(Instant now, std::string& known, const char* kind, const std::string& sentence,
                    Severity severity) const {
  if (std::exchange(known, sentence) == sentence) return;
  notify_({now, severity, kind, "", sentence});
}

}  // namespace recald::daemon
