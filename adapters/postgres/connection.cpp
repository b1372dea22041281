#include "adapters/postgres/connection.hpp"

#include <fmt/format.h>
#include <libpq-fe.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <thread>
#include <utility>

namespace recald::postgres {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// Of the connection's life on our side: an idle one asks the peer after 10 s, sent bytes are
/// acknowledged within 25 s.
constexpr auto kSettings = std::to_array<std::pair<const char*, const char*>>({
    {"application_name", "recald"},
    {"client_encoding", "UTF8"},
    {"keepalives", "1"},
    {"keepalives_idle", "10"},
    {"keepalives_interval", "5"},
    {"keepalives_count", "3"},
    {"tcp_user_timeout", "25000"},
});

/// The same on the server's side, which else keeps what a vanished client had locked for hours.
constexpr auto kSession =
    "SET timezone = 'UTC'; SET client_min_messages = warning; SET lock_timeout = '30s'; "
    "SET idle_in_transaction_session_timeout = '60s'; SET tcp_keepalives_idle = 10; "
    "SET tcp_keepalives_interval = 5; SET tcp_keepalives_count = 3; SET tcp_user_timeout = 25000";

constexpr milliseconds kConnectMax{10'000};
constexpr milliseconds kFarewell{3'000};  ///< After a stop.
constexpr int kTries = 3;                 ///< Of a transaction that lost to another.
constexpr milliseconds kPause{50};
constexpr std::string_view kUniqueViolation = "23505";

PGresult* of(const std::shared_ptr<void>& result) { return static_cast<PGresult*>(result.get()); }

/// What the library says in one line, without what the sentence around it says.
std::string one_line(std::string_view words) {
  std::string line;
  for (const char c : words) {
    const bool is_space = c == '\n' || c == '\t' || c == ' ';
    if (!is_space) line += c;
    if (is_space && !line.empty() && line.back() != ' ') line += ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  constexpr std::string_view failed = "failed: ";
  const std::size_t at = line.find(failed);
  const bool is_prefixed = line.starts_with("connection to server") && at != std::string::npos &&
                           line.find(failed, at + 1) == std::string::npos;
  return is_prefixed ? line.substr(at + failed.size()) : line;
}

/// Whether the same statement may go later (PostgreSQL 15, appendix A).
bool may_go_later(std::string_view state) {
  for (const char* kind : {"08", "40", "53", "57", "58"}) {
    if (state.starts_with(kind)) return true;
  }
  // The transaction was idle for too long, the server is a standby now, a lock was not free.
  return state == "25P03" || state == "25006" || state == "55P03";
}

std::vector<const char*> pointers(const std::vector<Parameter>& parameters) {
  std::vector<const char*> values;
  values.reserve(parameters.size());
  for (const Parameter& one : parameters) values.push_back(one ? one->c_str() : nullptr);
  return values;
}

bool has_zero_byte(const std::vector<Parameter>& parameters) {
  return std::ranges::any_of(
      parameters, [](const Parameter& one) { return one && one->find('\0') != std::string::npos; });
}

/// Readable once the token is told to stop.
class StopEvent {
 public:
  explicit StopEvent(const std::stop_token& stop)
      : file_{::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)}, on_stop_{stop, Wake{file_}} {}
  ~StopEvent() { ::close(file_); }
  StopEvent(const StopEvent&) = delete;
  StopEvent& operator=(const StopEvent&) = delete;

  [[nodiscard]] int file() const { return file_; }

 private:
  struct Wake {
    int file;
    void operator()() const { ::eventfd_write(file, 1); }
  };
  int file_;
  std::stop_callback<Wake> on_stop_;
};

/// A wait with an end: `due`, or a little after a stop.
class Wait {
 public:
  Wait(milliseconds time_max, const std::stop_token& stop)
      : stop_{stop}, stopped_{stop}, due_{steady_clock::now() + time_max} {}

  /// @return whether something may have happened on the socket; false: it is over.
  [[nodiscard]] bool for_socket(int socket, short events) {
    if (stop_.stop_requested() && !is_told_) {
      is_told_ = true;
      due_ = std::min(due_, steady_clock::now() + kFarewell);
    }
    const auto left = std::chrono::ceil<milliseconds>(due_ - steady_clock::now());
    if (left.count() <= 0) return false;
    std::array<::pollfd, 2> files{
        {{socket, events, 0}, {is_told_ ? -1 : stopped_.file(), POLLIN, 0}}};
    ::poll(files.data(), files.size(), static_cast<int>(left.count()));
    return true;
  }

 private:
  const std::stop_token& stop_;
  StopEvent stopped_;
  steady_clock::time_point due_;
  bool is_told_ = false;
};

}  // namespace

Parameter integer(std::int64_t value) { return std::to_string(value); }

Parameter real(double value) {
  return std::isnan(value) ? Parameter{} : Parameter{fmt::format("{}", value)};
}

Parameter bytes(std::string_view data) {
  constexpr std::string_view kHexDigits = "0123456789abcdef";
  std::string text = "\\x";
  text.reserve(2 + 2 * data.size());
  for (const char c : data) {
    const auto byte = static_cast<unsigned char>(c);
    text += kHexDigits[byte >> 4];
    text += kHexDigits[byte & 0xF];
  }
  return text;
}

void Array::begin_value() {
  if (text_.size() > 1) text_ += ',';
}

Array& Array::add(std::int64_t value) {
  begin_value();
  fmt::format_to(std::back_inserter(text_), "{}", value);
  return *this;
}

Array& Array::add(double value) {
  begin_value();
  if (std::isnan(value)) {
    text_ += "NULL";
  } else {
    fmt::format_to(std::back_inserter(text_), "{}", value);
  }
  return *this;
}

Array& Array::add(std::string_view text) {
  begin_value();
  text_ += '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') text_ += '\\';
    text_ += c;
  }
  text_ += '"';
  return *this;
}

int Rows::size() const { return PQntuples(of(result_)); }

bool Rows::is_null(int row, int column) const { return PQgetisnull(of(result_), row, column) != 0; }

std::string_view Rows::text(int row, int column) const {
  return {PQgetvalue(of(result_), row, column),
          static_cast<std::size_t>(PQgetlength(of(result_), row, column))};
}

std::int64_t Rows::integer(int row, int column) const {
  const std::string_view digits = text(row, column);
  std::int64_t value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return value;
}

double Rows::real(int row, int column) const {
  if (is_null(row, column)) return std::numeric_limits<double>::quiet_NaN();
  const std::string_view digits = text(row, column);
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return value;
}

bool Rows::boolean(int row, int column) const { return text(row, column) == "t"; }

std::string Rows::bytes(int row, int column) const {
  const std::string_view escaped = text(row, column);
  std::size_t size = 0;
  const std::unique_ptr<unsigned char, decltype(&PQfreemem)> data{
      PQunescapeBytea(reinterpret_cast<const unsigned char*>(escaped.data()), &size), &PQfreemem};
  return {reinterpret_cast<const char*>(data.get()), size};
}

std::int64_t Rows::affected() const {
  const std::string_view digits = PQcmdTuples(of(result_));
  std::int64_t value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return value;
}

struct Connection::Impl {
  struct Finish {
    void operator()(PGconn* connection) const { PQfinish(connection); }
  };
  using Handle = std::unique_ptr<PGconn, Finish>;

  std::string url, password;
  Patience patience{};
  std::string name{};  ///< "PostgreSQL at db.example:5432/fleet"
  Handle handle{};
  bool is_in_transaction = false;
  std::string state{};  ///< SQLSTATE of the last failure; empty: none, or the connection's.
  // Of the session, and lost with it.
  std::map<std::string, std::string> prepared{};
  std::set<std::string> listened{};
  std::set<std::string> notified{};

  [[nodiscard]] Result<void> connect() {
    std::vector<const char*> keywords{"dbname"}, values{url.c_str()};
    for (const auto& [keyword, value] : kSettings) {
      keywords.push_back(keyword);
      values.push_back(value);
    }
    if (!password.empty()) {
      keywords.push_back("password");
      values.push_back(password.c_str());
    }
    keywords.push_back(nullptr);
    values.push_back(nullptr);
    prepared.clear();
    listened.clear();
    notified.clear();
    handle.reset();
    Handle made{PQconnectStartParams(keywords.data(), values.data(), 1)};
    if (auto connected = finish_connecting(made.get()); !connected) return connected;
    handle = std::move(made);
    // Or the library writes to our standard error what a server says when it ends.
    PQsetNoticeProcessor(
        handle.get(), [](void*, const char*) {}, nullptr);
    // Else what does not fit into the socket's buffer waits without a limit.
    PQsetnonblocking(handle.get(), 1);
    return simple(kSession);
  }

  [[nodiscard]] Result<void> finish_connecting(PGconn* made) const {
    Wait wait{kConnectMax, patience.stop};
    auto next = PGRES_POLLING_WRITING;
    while (next == PGRES_POLLING_READING || next == PGRES_POLLING_WRITING) {
      const short events = next == PGRES_POLLING_READING ? POLLIN : POLLOUT;
      if (PQstatus(made) == CONNECTION_BAD) break;
      if (!wait.for_socket(PQsocket(made), events)) {
        return failure(ErrorCode::io_failed,
                       fmt::format("{} cannot be reached: it does not answer", name));
      }
      next = PQconnectPoll(made);
    }
    if (PQstatus(made) == CONNECTION_OK) return {};
    return failure(ErrorCode::io_failed,
                   fmt::format("{} cannot be reached: {}", name, one_line(PQerrorMessage(made))));
  }

  /// Waits until the library has read the next result. @return or io_failed, and the connection is
  /// given up: the server does not answer.
  [[nodiscard]] Result<void> await() {
    Wait wait{patience.answer_max, patience.stop};
    for (;;) {
      const int left = PQflush(handle.get());
      // Of a connection that is lost the library has a result that says so.
      if (left < 0 || (left == 0 && PQisBusy(handle.get()) == 0)) return {};
      const short events = left > 0 ? POLLIN | POLLOUT : POLLIN;
      if (!wait.for_socket(PQsocket(handle.get()), events)) {
        handle.reset();
        return failure(ErrorCode::io_failed, name + " does not answer");
      }
      if (PQconsumeInput(handle.get()) == 0) return {};
    }
  }

  /// The last result of what was sent. @param sent  What the library said of the sending.
  [[nodiscard]] Result<Rows> answered(int sent) {
    if (sent == 0) return lost();
    PGresult* last = nullptr;
    for (;;) {
      if (auto read = await(); !read) {
        PQclear(last);
        return tl::unexpected(read.error());
      }
      PGresult* const one = PQgetResult(handle.get());
      if (one == nullptr) break;
      PQclear(std::exchange(last, one));
    }
    if (last == nullptr) return lost();
    return finished(last);
  }

  /// Reads what an idle connection may hold: news, or the server's last words and the end.
  [[nodiscard]] bool is_alive() const {
    if (handle == nullptr) return false;
    for (;;) {
      if (PQconsumeInput(handle.get()) == 0 || PQstatus(handle.get()) != CONNECTION_OK) {
        return false;
      }
      ::pollfd event{PQsocket(handle.get()), POLLIN, 0};
      if (::poll(&event, 1, 0) <= 0) return true;
    }
  }

  /// Makes a broken connection again, but not within a transaction, which went with it.
  [[nodiscard]] Result<void> ready() {
    if (is_in_transaction && handle) return {};
    if (is_in_transaction) return failure(ErrorCode::io_failed, name + ": the connection is lost");
    return is_alive() ? Result<void>{} : connect();
  }

  [[nodiscard]] tl::unexpected<Error> refused(const PGresult* result) {
    const char* const code = PQresultErrorField(result, PG_DIAG_SQLSTATE);
    const char* const words = PQresultErrorField(result, PG_DIAG_MESSAGE_PRIMARY);
    const char* const detail = PQresultErrorField(result, PG_DIAG_MESSAGE_DETAIL);
    const bool is_lost = PQstatus(handle.get()) != CONNECTION_OK;
    state = code != nullptr ? code : "";
    std::string why = words != nullptr ? words : one_line(PQerrorMessage(handle.get()));
    if (detail != nullptr) why += fmt::format(" ({})", one_line(detail));
    if (is_lost) {
      return failure(ErrorCode::io_failed,
                     fmt::format("{}: the connection is lost: {}", name, why));
    }
    return failure(may_go_later(state) ? ErrorCode::io_failed : ErrorCode::malformed,
                   fmt::format("{}: {}", name, why));
  }

  /// Takes a result of the library. @return its rows, or what the server said.
  [[nodiscard]] Result<Rows> finished(PGresult* result) {
    Rows rows;
    rows.result_ = {result, [](void* one) { PQclear(static_cast<PGresult*>(one)); }};
    const ExecStatusType status = PQresultStatus(result);
    if (status == PGRES_TUPLES_OK || status == PGRES_COMMAND_OK || status == PGRES_SINGLE_TUPLE ||
        status == PGRES_EMPTY_QUERY) {
      return rows;
    }
    return refused(result);
  }

  [[nodiscard]] Result<void> simple(const char* statements) {
    TRY(answered(PQsendQuery(handle.get(), statements)));
    return {};
  }

  [[nodiscard]] Result<std::string> name_of(const std::string& statement) {
    if (const auto known = prepared.find(statement); known != prepared.end()) return known->second;
    std::string made = fmt::format("s{}", prepared.size());
    TRY(answered(PQsendPrepare(handle.get(), made.c_str(), statement.c_str(), 0, nullptr)));
    prepared.emplace(statement, made);
    return made;
  }

  [[nodiscard]] Result<void> commit() {
    const auto done = TRY(answered(PQsendQuery(handle.get(), "COMMIT")));
    // A transaction in which a statement failed is rolled back, and COMMIT says so quietly.
    if (std::string_view{PQcmdStatus(of(done.result_))} == "COMMIT") return {};
    return failure(ErrorCode::malformed, name + ": the transaction was rolled back");
  }

  [[nodiscard]] Result<void> once(const std::function<Result<void>()>& work) {
    state.clear();
    if (auto good = ready(); !good) return good;
    if (auto begun = simple("BEGIN"); !begun) return begun;
    struct Ended {
      bool& is_in_transaction;
      ~Ended() { is_in_transaction = false; }
    } ended{is_in_transaction};
    is_in_transaction = true;
    auto done = work();
    if (done) done = commit();
    if (!done && handle && PQtransactionStatus(handle.get()) != PQTRANS_IDLE) {
      if (!simple("ROLLBACK")) handle.reset();  // the server rolls back what is left
    }
    return done;
  }

  /// Takes note of what has been notified.
  void collect_notified() {
    while (PGnotify* const one = PQnotifies(handle.get())) {
      notified.insert(one->relname);
      PQfreemem(one);
    }
  }

  [[nodiscard]] tl::unexpected<Error> lost() const {
    return failure(ErrorCode::io_failed, fmt::format("{}: the connection is lost: {}", name,
                                                     one_line(PQerrorMessage(handle.get()))));
  }
};

Connection::Connection(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
Connection::~Connection() = default;

Result<std::unique_ptr<Connection>> Connection::open(const std::string& url,
                                                     const std::string& password,
                                                     const Patience& patience) {
  const std::unique_ptr<PQconninfoOption, decltype(&PQconninfoFree)> options{
      PQconninfoParse(url.c_str(), nullptr), &PQconninfoFree};
  const bool is_url = url.starts_with("postgresql://") || url.starts_with("postgres://");
  if (!is_url || options == nullptr) {  // what it says may quote a password
    return failure(ErrorCode::invalid_value,
                   "the record needs an address such as postgresql://user@host:5432/fleet");
  }
  std::map<std::string, std::string> given;
  for (const PQconninfoOption* one = options.get(); one->keyword != nullptr; ++one) {
    if (one->val != nullptr) given[one->keyword] = one->val;
  }
  std::string name =
      fmt::format("PostgreSQL at {}:{}/{}", given["host"].empty() ? "localhost" : given["host"],
                  given["port"].empty() ? "5432" : given["port"], given["dbname"]);
  if (!given["password"].empty()) {
    return failure(ErrorCode::invalid_value,
                   fmt::format("the address of {} has a password in it: take it out, and give it "
                               "where passwords belong",
                               name));
  }
  auto impl = std::make_unique<Impl>(
      Impl{.url = url, .password = password, .patience = patience, .name = name});
  TRY(impl->connect());
  return std::unique_ptr<Connection>{new Connection{std::move(impl)}};
}

Result<Rows> Connection::run(const std::string& statement,
                             const std::vector<Parameter>& parameters) {
  if (has_zero_byte(parameters)) {
    return failure(ErrorCode::malformed, "a text for the record has a zero byte");
  }
  TRY(impl_->ready());
  const auto name = TRY(impl_->name_of(statement));
  const auto values = pointers(parameters);
  return impl_->answered(PQsendQueryPrepared(impl_->handle.get(), name.c_str(),
                                             static_cast<int>(values.size()), values.data(),
                                             nullptr, nullptr, 0));
}

Result<void> Connection::run_all(const std::string& statements) {
  if (auto good = impl_->ready(); !good) return good;
  return impl_->simple(statements.c_str());
}

Result<void> Connection::transaction(const std::function<Result<void>()>& work) {
  assert(!impl_->is_in_transaction);
  for (int tries = 1;; ++tries) {
    auto done = impl_->once(work);
    // Somebody else was faster: a lock in another order, or a row of the same key.
    const bool may_go_now = impl_->state.starts_with("40") || impl_->state == kUniqueViolation;
    if (done || !may_go_now || tries == kTries) return done;
    std::this_thread::sleep_for(tries * kPause);  // it takes its lock before we do
  }
}

Result<void> Connection::for_each(const std::string& statement,
                                  const std::vector<Parameter>& parameters,
                                  const std::function<Result<void>(const Rows& row)>& visit) {
  if (auto good = impl_->ready(); !good) return good;
  PGconn* const connection = impl_->handle.get();
  const auto values = pointers(parameters);
  if (PQsendQueryParams(connection, statement.c_str(), static_cast<int>(values.size()), nullptr,
                        values.data(), nullptr, nullptr, 0) == 0) {
    return impl_->lost();
  }
  PQsetSingleRowMode(connection);
  for (;;) {
    TRY(impl_->await());
    PGresult* const result = PQgetResult(connection);
    if (result == nullptr) return {};
    const auto rows = impl_->finished(result);
    if (!rows) {
      while (impl_->await()) {
        PGresult* const rest = PQgetResult(connection);
        if (rest == nullptr) break;
        PQclear(rest);
      }
      return tl::unexpected(rows.error());
    }
    if (PQresultStatus(result) != PGRES_SINGLE_TUPLE) continue;
    if (auto visited = visit(*rows); !visited) {
      // To cancel would be to wait for a server that may not answer; with the connection the
      // answer ends too.
      impl_->handle.reset();
      return visited;
    }
  }
}

Result<bool> Connection::wait_for(const std::string& channel, milliseconds time_max,
                                  const std::stop_token& stop) {
  TRY(impl_->ready());
  PGconn* const connection = impl_->handle.get();
  if (!impl_->listened.contains(channel)) {
    TRY(impl_->simple(fmt::format("LISTEN \"{}\"", channel).c_str()));
    impl_->listened.insert(channel);
    return true;
  }
  const StopEvent stopped{stop};
  const auto due = steady_clock::now() + time_max;
  for (;;) {
    if (PQconsumeInput(connection) == 0) return impl_->lost();
    impl_->collect_notified();
    if (impl_->notified.erase(channel) > 0) return true;
    const auto left = std::chrono::ceil<milliseconds>(due - steady_clock::now());
    if (stop.stop_requested() || left.count() <= 0) return false;
    std::array<::pollfd, 2> events{
        {{PQsocket(connection), POLLIN, 0}, {stopped.file(), POLLIN, 0}}};
    const auto wait = std::min<milliseconds::rep>(left.count(), std::numeric_limits<int>::max());
    ::poll(events.data(), events.size(), static_cast<int>(wait));
  }
}

std::string library_version() {
  const int version = PQlibVersion();  // 150008 is 15.8
  return fmt::format("{}.{}", version / 10000, version % 10000);
}

}  // namespace recald::postgres
