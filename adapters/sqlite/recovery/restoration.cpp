#include "adapters/sqlite/recovery/restoration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "adapters/sqlite/damage.hpp"
#include "adapters/sqlite/sqlite_store.hpp"
#include "adapters/sqlite/store_files.hpp"
#include "adapters/sqlite/summary.hpp"
#include "adapters/sqlite/tables/outbox_table.hpp"
#include "adapters/sqlite/tables/schema.hpp"
#include "adapters/system/files/durable_names.hpp"
#include "adapters/system/files/file_rights.hpp"
#include "adapters/system/files/regular_file.hpp"

namespace recald::sqlite {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDecided = ".restored-";

fs::path copy_of(const fs::path& store) { return store.string() + ".restoring"; }
fs::path decided_name(const fs::path& store, const std::string& stamp) {
  return fmt::format("{}{}{}", store.string(), kDecided, stamp);
}
fs::path replaced_name(const fs::path& store, const std::string& stamp) {
  return fmt::format("{}.replaced-{}", store.string(), stamp);
}
fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path{"."};
}

/// The stamp of a restoration that was decided and is not finished; empty: none.
Result<std::string> decided_stamp(const fs::path& store) {
  const std::string prefix = store.filename().string() + std::string{kDecided};
  std::error_code error;
  for (fs::directory_iterator one{folder_of(store), error}, end; !error && one != end;
       one.increment(error)) {
    const std::string name = one->path().filename().string();
    if (name.starts_with(prefix)) return name.substr(prefix.size());
  }
  // Opening the store will say what is wrong with a folder that is not there.
  if (!error || error == std::errc::no_such_file_or_directory) return std::string{};
  return failure(ErrorCode::io_failed, fmt::format("the folder of '{}' cannot be read: {}",
                                                   store.string(), error.message()));
}

/// Gives a store a second name, so that one is in place at every moment; or, on a file system
/// without such names, another.
Result<void> keep_as(const fs::path& store, const fs::path& replaced) {
  if (!is_there(store) || is_there(replaced)) return {};
  std::error_code error;
  fs::create_hard_link(store, replaced, error);
  return error ? system::rename_durably(store, replaced) : system::flush_folder_of(replaced);
}

Result<void> copy_file(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
  if (!error) fs::permissions(to, fs::perms{system::kPrivateMode}, error);
  if (!error) return {};
  return failure(ErrorCode::io_failed, fmt::format("'{}' cannot be copied to '{}': {}",
                                                   from.string(), to.string(), error.message()));
}

/// The number of the last job of a store; 0: it had none, or cannot be read.
std::int64_t last_job(const fs::path& store) {
  auto database = open_untouched(store);
  constexpr int kFirstWithJobs = 2;
  if (!database || schema_version(*database).value_or(0) < kFirstWithJobs) return 0;
  auto query = database->prepare("SELECT max(seq) FROM sqlite_sequence WHERE name = 'job'");
  return query && query->step().value_or(false) ? query->integer(0) : 0;
}

class Restoration final : public StoreRestoration {
 public:
  Restoration(fs::path store, fs::path backup)
      : store_(std::move(store)), backup_(std::move(backup)), copy_(copy_of(store_)) {}
  ~Restoration() override {
    opened_.reset();
    remove_store(copy_);
  }
  Restoration(const Restoration&) = delete;
  Restoration& operator=(const Restoration&) = delete;

  Result<void> prepare(const OnProgress& on_progress) {
    remove_store(copy_);  // left by an earlier process; its log would be played into this copy
    for (const char* part : {"", "-wal"}) {
      if (*part != '\0' && !is_there(backup_.string() + part)) continue;
      if (auto copied = copy_file(backup_.string() + part, copy_.string() + part); !copied) {
        return copied;
      }
      if (on_progress) on_progress();
    }
    const auto damage = TRY(damage_of(copy_, on_progress));
    if (!damage.empty()) return failure(ErrorCode::malformed, "it is damaged: " + damage);
    TRY(summary_of(copy_));
    auto opened = TRY(SqliteStore::open(copy_));
    opened_.emplace(std::move(opened));
    summary_ = TRY(summary_of(opened_->database()));
    return {};
  }

  [[nodiscard]] const StoreSummary& summary() const override { return summary_; }

  Result<fs::path> keep(metering::Instant now) override {
    const std::string stamp = free_stamp(now);
    TRY(add_event(replaced_name(store_, stamp), now));
    TRY(number_jobs_on());
    TRY(forget_identities(opened_->database()));
    // Moves everything into the one file that is renamed.
    TRY(opened_->database().execute("PRAGMA wal_checkpoint(TRUNCATE)"));
    opened_.reset();
    system::own_like(copy_, is_there(store_) ? store_ : folder_of(store_));
    TRY(system::rename_durably(copy_, decided_name(store_, stamp)));
    return finish_restoration(store_);
  }

 private:
  /// For names that nobody has.
  [[nodiscard]] std::string free_stamp(metering::Instant now) const {
    const fs::path wanted = replaced_name(store_, stamp_of(now));
    return stamp_of(now) + free_name(wanted).string().substr(wanted.string().size());
  }

  /// Jobs have folders by their numbers: those of the replaced store are not written over.
  Result<void> number_jobs_on() {
    return opened_->database().execute(
        fmt::format("DELETE FROM sqlite_sequence WHERE name = 'job' AND seq < {0};"
                    "INSERT INTO sqlite_sequence SELECT 'job', {0} WHERE NOT EXISTS "
                    "(SELECT 1 FROM sqlite_sequence WHERE name = 'job')",
                    is_there(store_) ? last_job(store_) : 0));
  }

  Result<void> add_event(const fs::path& replaced, metering::Instant now) {
    const auto time = TRY(time_of_event(opened_->database(), now));
    std::string text = fmt::format("the store is the backup '{}'", backup_.filename().string());
    if (summary_.newest) {
      text += fmt::format(", whose newest reading is of {}", metering::to_string(*summary_.newest));
    }
    if (is_there(store_)) {
      text +=
          fmt::format("; the store that it replaced is kept as '{}'", replaced.filename().string());
    }
    const auto added =
        opened_->commit({.events = {{time, Severity::warning, "store_restored", "", text}}});
    return added ? Result<void>{} : tl::unexpected(added.error());
  }

  fs::path store_;
  fs::path backup_;
  fs::path copy_;
  std::optional<SqliteStore> opened_;  ///< The copy.
  StoreSummary summary_;
};

}  // namespace

Result<std::unique_ptr<StoreRestoration>> begin_restoration(const fs::path& store,
                                                            const fs::path& backup,
                                                            const OnProgress& on_progress) {
  auto restoration = std::make_unique<Restoration>(store, backup);
  TRY(restoration->prepare(on_progress));
  return restoration;
}

bool has_unfinished_restoration(const fs::path& store) {
  const auto stamp = decided_stamp(store);
  return stamp && !stamp->empty();
}

Result<fs::path> finish_restoration(const fs::path& store) {
  if (is_there(copy_of(store))) remove_store(copy_of(store));
  const auto stamp = TRY(decided_stamp(store));
  if (stamp.empty()) return fs::path{};
  const fs::path replaced = replaced_name(store, stamp);
  // The old log must be gone before the copy has the store's name, or SQLite would play it into it.
  if (is_there(store.string() + "-wal")) {
    TRY(system::rename_durably(store.string() + "-wal", replaced.string() + "-wal"));
  }
  // An unfinished recovery was of the store that is replaced.
  for (const char* left : {"-shm", ".recovery", ".recovering"}) {
    if (!is_there(store.string() + left)) continue;
    TRY(system::remove_durably(store.string() + left));
  }
  TRY(keep_as(store, replaced));
  TRY(system::rename_durably(decided_name(store, stamp), store));
  return is_there(replaced) ? replaced : fs::path{};
}

}  // namespace recald::sqlite
