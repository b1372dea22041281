#include "daemon/gateway/upkeep/upkeep.hpp"

#include <algorithm>
#include <utility>

#include "adapters/system/write_file.hpp"
#include "daemon/gateway/upkeep/backups.hpp"
#include "daemon/gateway/upkeep/job_folder.hpp"
#include "daemon/gateway/upkeep/open_store.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using std::chrono::milliseconds;

constexpr milliseconds kRest = std::chrono::hours{1};

}  // namespace

Upkeep::Upkeep(Store& store, StoreConfig config, metering::LocalCalendar calendar,
               std::function<void(StoreEvent)> tell, const UpkeepRules& rules)
    : store_(store),
      config_(std::move(config)),
      calendar_(std::move(calendar)),
      tell_(std::move(tell)),
      rules_(rules),
      reserve_(
          std::make_shared<system::ReservedSpace>(reserve_file(config_), rules.reserve_bytes)) {
  store_.on_refusal([reserve = reserve_] { return reserve->give_up(); });
}

milliseconds Upkeep::maintain(Instant now) {
  hold_reserve(now);
  const auto backed_up = back_up(now);
  if (!backed_up) {
    backup_.reset();
    tell(now, backup_failure_, "backup_failed", backed_up.error().message);
  } else if (*backed_up == Progress::more) {
    return rules_.pause;
  }
  const auto deleted = delete_old(now);
  if (!deleted) {
    tell(now, deleting_failure_, "old_not_deleted", deleted.error().message);
  } else if (*deleted == Progress::more) {
    return rules_.pause;
  }
  return until_next(now);
}

void Upkeep::hold_reserve(Instant now) {
  if (auto held = reserve_->hold(); !held) {
    tell(now, reserve_failure_, "no_reserve", held.error().message);
  } else {
    reserve_failure_.clear();
  }
}

Result<Upkeep::Progress> Upkeep::back_up(Instant now) {
  if (!backup_) return begin_backup(now);
  const auto is_whole = backup_->step(rules_.backup_pages);
  if (!is_whole) return tl::unexpected(is_whole.error());
  if (!*is_whole) return Progress::more;
  backup_.reset();
  backup_failure_.clear();
  for (const std::filesystem::path& file : prune_backups(config_)) {
    tell(now, backup_failure_, "backup_failed", "'" + file.string() + "' cannot be deleted");
  }
  return Progress::done;
}

/// Due is today's once its time has come, whatever happened meanwhile: the folder remembers.
Result<Upkeep::Progress> Upkeep::begin_backup(Instant now) {
  const auto today = calendar_.local_time(now).date;
  if (!config_.backup_at) return Progress::done;
  if (now < calendar_.first_instant(today, static_cast<int>(config_.backup_at->count()))) {
    return Progress::done;
  }
  const std::filesystem::path file = backup_file(config_, today);
  if (std::error_code unreadable; std::filesystem::exists(file, unreadable)) return Progress::done;
  if (auto made = system::make_folder(config_.backup_folder); !made) {
    return tl::unexpected(made.error());
  }
  auto begun = store_.begin_backup(file);
  if (!begun) return tl::unexpected(begun.error());
  backup_ = std::move(*begun);
  return Progress::more;
}

Result<Upkeep::Progress> Upkeep::delete_old(Instant now) {
  const auto samples = store_.delete_samples(now - config_.raw_kept, rules_.rows);
  if (!samples) return tl::unexpected(samples.error());
  if (*samples == rules_.rows) return Progress::more;
  const auto events = store_.delete_events(now - config_.events_kept, rules_.rows);
  if (!events) return tl::unexpected(events.error());
  if (*events == rules_.rows) return Progress::more;
  for (const JobKind kind : {JobKind::calibration, JobKind::diagnosis}) {
    const auto results = delete_results(kind);
    if (!results || *results == Progress::more) return results;
  }
  deleting_failure_.clear();
  return Progress::done;
}

/// One at a time, its files first: killed in between, it is still known and its turn comes again.
Result<Upkeep::Progress> Upkeep::delete_results(JobKind kind) {
  const auto job = store_.oldest_job_beyond(kind, config_.results_kept);
  if (!job) return tl::unexpected(job.error());
  if (!*job) return Progress::done;
  const std::filesystem::path folder = job_folder(config_, kind, (*job)->number);
  std::error_code error;
  std::filesystem::remove_all(folder, error);
  if (error) {
    return failure(ErrorCode::io_failed,
                   "folder '" + folder.string() + "' cannot be deleted: " + error.message());
  }
  if (auto deleted = store_.delete_job((*job)->number); !deleted) {
    return tl::unexpected(deleted.error());
  }
  return Progress::more;
}

milliseconds Upkeep::until_next(Instant now) const {
  if (!config_.backup_at) return kRest;
  const auto minute = static_cast<int>(config_.backup_at->count());
  const Instant due = calendar_.first_instant(calendar_.local_time(now).date, minute);
  return due > now ? std::min<milliseconds>(kRest, due - now) : kRest;
}

/// The same failure hour after hour is one event.
void Upkeep::tell(Instant now, std::string& known, const char* kind,
                  const std::string& sentence) const {
  if (std::exchange(known, sentence) == sentence) return;
  tell_({now, Severity::warning, kind, "", sentence});
}

}  // namespace recald::daemon
