#include "adapters/sqlite/tables/database.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cassert>
#include <utility>

#include "adapters/sqlite/tables/handles.hpp"
#include "adapters/system/files/regular_file.hpp"
#include "core/absent.hpp"

namespace recald::sqlite {
namespace {

constexpr int kBusyTimeout_ms = 5000;

/// A file's name as SQLite takes it with options after it.
std::string still_name(const std::filesystem::path& file) {
  std::string name = "file:";
  for (const char c : file.string()) {
    const bool has_meaning = c == '%' || c == '?' || c == '#';
    name += has_meaning ? fmt::format("%{:02x}", static_cast<unsigned>(c)) : std::string{c};
  }
  return name + "?immutable=1";
}

}  // namespace

ErrorCode code_of(int result) {
  switch (result & 0xFF) {
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
    case SQLITE_FORMAT:
      return ErrorCode::malformed;
    case SQLITE_CONSTRAINT:
    case SQLITE_MISMATCH:
    case SQLITE_TOOBIG:
      return ErrorCode::invalid_value;
    default:
      return ErrorCode::io_failed;
  }
}

tl::unexpected<Error> failed(int result, sqlite3* database, std::string_view file) {
  const char* words = database != nullptr ? sqlite3_errmsg(database) : sqlite3_errstr(result);
  return failure(code_of(result), fmt::format("store '{}': {} (SQLite {})", file, words, result));
}

struct Statement::Impl {
  StatementHandle handle;
  std::string file;
};

Statement::Statement(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Statement::~Statement() = default;
Statement::Statement(Statement&&) noexcept = default;
Statement& Statement::operator=(Statement&&) noexcept = default;

Statement& Statement::bind(int parameter, std::int64_t value) {
  [[maybe_unused]] const int result = sqlite3_bind_int64(impl_->handle.get(), parameter + 1, value);
  assert(result == SQLITE_OK && "the statement has this parameter");
  return *this;
}

Statement& Statement::bind(int parameter, double value) {
  [[maybe_unused]] const int result =
      sqlite3_bind_double(impl_->handle.get(), parameter + 1, value);
  assert(result == SQLITE_OK && "the statement has this parameter");
  return *this;
}

Statement& Statement::bind(int parameter, std::string_view text) {
  [[maybe_unused]] const int result = sqlite3_bind_text64(
      impl_->handle.get(), parameter + 1, text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
  assert(result == SQLITE_OK && "the statement has this parameter");
  return *this;
}

Statement& Statement::bind_null(int parameter) {
  [[maybe_unused]] const int result = sqlite3_bind_null(impl_->handle.get(), parameter + 1);
  assert(result == SQLITE_OK && "the statement has this parameter");
  return *this;
}

Statement& Statement::bind_column(int parameter, const Statement& row, int column) {
  [[maybe_unused]] const int result = sqlite3_bind_value(
      impl_->handle.get(), parameter + 1, sqlite3_column_value(row.impl_->handle.get(), column));
  assert(result == SQLITE_OK && "the statement has this parameter");
  return *this;
}

Result<bool> Statement::step() {
  const int result = sqlite3_step(impl_->handle.get());
  if (result == SQLITE_ROW) return true;
  if (result == SQLITE_DONE) {
    reset();
    return false;
  }
  auto failure_ = failed(result, sqlite3_db_handle(impl_->handle.get()), impl_->file);
  reset();
  return failure_;
}

Result<void> Statement::run() {
  for (;;) {
    const auto row = TRY(step());
    if (!row) return {};
  }
}

void Statement::reset() { sqlite3_reset(impl_->handle.get()); }

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(impl_->handle.get(), column);
}

double Statement::real(int column) const {
  return is_null(column) ? kAbsent : sqlite3_column_double(impl_->handle.get(), column);
}

std::string Statement::text(int column) const {
  const auto* bytes = sqlite3_column_text(impl_->handle.get(), column);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(impl_->handle.get(), column));
  return bytes == nullptr ? std::string{} : std::string{reinterpret_cast<const char*>(bytes), size};
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(impl_->handle.get(), column) == SQLITE_NULL;
}

Database::Database(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Database::~Database() = default;
Database::Database(Database&&) noexcept = default;
Database& Database::operator=(Database&&) noexcept = default;

Result<Database> Database::open(const std::filesystem::path& file, const Options& options) {
  const bool writes = options.access == Access::read_write;
  const int flags = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE |
                    (writes ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY) |
                    (options.is_still ? SQLITE_OPEN_URI : 0);
  const bool is_on_disk = options.vfs.empty() && file != ":memory:";
  if (writes && is_on_disk) system::make_private_file(file);  // log and index get the same rights
  sqlite3* raw = nullptr;
  const std::string name = options.is_still ? still_name(file) : file.string();
  const int result = sqlite3_open_v2(name.c_str(), &raw, flags,
                                     options.vfs.empty() ? nullptr : options.vfs.c_str());
  Database database{std::make_unique<Impl>(Impl{DatabaseHandle{raw}, file.string()})};
  if (result != SQLITE_OK) return failed(result, raw, file.string());
  // SQLite opens a read-only file without complaint; a caller that wants to write
  // would wait forever.
  if (writes && sqlite3_db_readonly(raw, "main") == 1) {
    return failure(ErrorCode::io_failed,
                   "store '" + file.string() + "' cannot be opened for writing");
  }
  sqlite3_busy_timeout(raw, kBusyTimeout_ms);
  add_row_sum(raw);
  // These read the first page, so a file that is not a database is reported here.
  const std::string pragmas =
      writes ? "PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; PRAGMA foreign_keys=ON;"
             : "PRAGMA wal_autocheckpoint=0; PRAGMA query_only=ON; SELECT count(*) FROM "
               "sqlite_schema;";
  if (auto set = database.execute(pragmas); !set) {
    // Our SQL is right, so if SQLite cannot parse something, the file is damaged, perhaps
    // by a flipped bit.
    const bool is_of_the_file = (sqlite3_errcode(raw) & 0xFF) == SQLITE_ERROR;
    return failure(is_of_the_file ? ErrorCode::malformed : set.error().code, set.error().message);
  }
  return database;
}

Result<void> Database::execute(const std::string& sql) {
  const int result = sqlite3_exec(impl_->handle.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (result != SQLITE_OK) return failed(result, impl_->handle.get(), impl_->file);
  return {};
}

Result<Statement> Database::prepare(std::string_view sql) {
  sqlite3_stmt* raw = nullptr;
  const int result =
      sqlite3_prepare_v3(impl_->handle.get(), sql.data(), static_cast<int>(sql.size()),
                         SQLITE_PREPARE_PERSISTENT, &raw, nullptr);
  assert((result & 0xFF) != SQLITE_ERROR && "our own SQL is right");
  if (result != SQLITE_OK) return failed(result, impl_->handle.get(), impl_->file);
  return Statement{
      std::make_unique<Statement::Impl>(Statement::Impl{StatementHandle{raw}, impl_->file})};
}

void Database::on_progress(OnProgress call) {
  constexpr int kSteps = 200'000;  // steps of SQLite's virtual machine: some milliseconds
  impl_->on_progress = std::move(call);
  sqlite3_progress_handler(
      impl_->handle.get(), impl_->on_progress ? kSteps : 0,
      [](void* called) {
        (*static_cast<std::function<void()>*>(called))();
        return 0;
      },
      &impl_->on_progress);
}

void Database::interrupt() { sqlite3_interrupt(impl_->handle.get()); }

template <class Handle>
Result<void> Database::run_kept(Handle& kept, std::string_view sql) {
  sqlite3* const database = impl_->handle.get();
  if (!kept) {
    sqlite3_stmt* raw = nullptr;
    const int result = sqlite3_prepare_v3(database, sql.data(), static_cast<int>(sql.size()),
                                          SQLITE_PREPARE_PERSISTENT, &raw, nullptr);
    if (result != SQLITE_OK) return failed(result, database, impl_->file);
    kept.reset(raw);
  }
  const int result = sqlite3_step(kept.get());
  auto done = result == SQLITE_DONE ? Result<void>{} : failed(result, database, impl_->file);
  sqlite3_reset(kept.get());
  return done;
}

Result<bool> Database::begin() {
  const bool is_part = sqlite3_get_autocommit(impl_->handle.get()) == 0;
  TRY(is_part ? execute("SAVEPOINT part") : run_kept(impl_->begin, "BEGIN IMMEDIATE"));
  return is_part;
}

Result<void> Database::finish(bool is_part) {
  return is_part ? execute("RELEASE part") : run_kept(impl_->commit, "COMMIT");
}

void Database::roll_back(bool is_part) {
  // Some failures (a full disk) have already rolled back, so there is nothing left to do.
  if (sqlite3_get_autocommit(impl_->handle.get()) != 0) return;
  (void)execute(is_part ? "ROLLBACK TO part; RELEASE part" : "ROLLBACK");
}

Result<std::string> Database::quick_check() {
  auto statement = TRY(prepare("PRAGMA quick_check(20)"));
  std::string damage;
  for (;;) {
    const auto row = statement.step();
    // Some damage aborts the check itself.
    if (!row && row.error().code == ErrorCode::malformed) {
      return damage.empty() ? row.error().message : damage;
    }
    if (!row) return tl::unexpected(row.error());
    if (!*row) return damage;
    const std::string line = statement.text(0);
    if (line == "ok") continue;
    if (!damage.empty()) damage += "; ";
    damage += line;
  }
}

}  // namespace recald::sqlite
