#include "tests/blind/scoring/result_log.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "tests/blind/scoring/files.hpp"
#include "tests/blind/scoring/seal.hpp"

namespace recald::blind {
namespace {

/// Joins files into one log: who said what where.
class LogBuilder {
 public:
  explicit LogBuilder(Reruns reruns) : reruns_(reruns) {}

  Result<void> add_file(std::string_view text, const std::string& name) {
    for (int number = 1; !text.empty(); ++number) {
      const std::size_t end = text.find('\n');
      const std::string where = fmt::format("{} line {}", name, number);
      if (end == std::string_view::npos) {
        log_.torn.push_back(fmt::format("{}: torn after {} bytes, ignored; the case runs again",
                                        where, text.size()));
        break;
      }
      auto added = add_line(text.substr(0, end), where);
      if (!added) return added;
      bytes_ += text.substr(0, end + 1);
      text.remove_prefix(end + 1);
    }
    return {};
  }

  ResultLog finish() {
    log_.hash = hash_of(bytes_);
    return std::move(log_);
  }

 private:
  Result<void> add_line(std::string_view line, const std::string& where) {
    auto result = parse_case_result(line, where);
    if (!result) return tl::unexpected(result.error());
    const auto [place, is_new] =
        places_.try_emplace({result->case_id, result->method}, Place{log_.results.size(), where});
    if (is_new) {
      log_.results.push_back(std::move(*result));
      return {};
    }
    if (reruns_ == Reruns::refuse) {
      return failure(ErrorCode::invalid_value,
                     fmt::format("case {} has two results of method {}: {} and {}; give "
                                 "--allow-rerun to let the later one count",
                                 result->case_id, result->method, place->second.where, where));
    }
    ++log_.replaced;
    log_.results[place->second.index] = std::move(*result);
    place->second.where = where;
    return {};
  }

  struct Place {
    std::size_t index;
    std::string where;
  };

  Reruns reruns_;
  ResultLog log_;
  std::string bytes_;
  std::map<std::pair<std::string, std::string>, Place> places_;
};

/// A descriptor that closes itself, and with it gives up the lock.
class LockedFile {
 public:
  explicit LockedFile(const std::filesystem::path& file)
      : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
    if (descriptor_ < 0) return;
    while (::flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
    }
  }
  ~LockedFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;

  [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }

  /// Puts `bytes` at `offset`, which becomes the place where the old content ends.
  [[nodiscard]] bool replace_tail(std::size_t offset, std::string_view bytes) const {
    auto at = static_cast<off_t>(offset);
    if (::ftruncate(descriptor_, at) != 0) return false;
    while (!bytes.empty()) {
      const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), at);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(written));
      at += written;
    }
    return ::fsync(descriptor_) == 0;
  }

 private:
  int descriptor_;
};

tl::unexpected<Error> cannot_append(const std::filesystem::path& file) {
  return failure(ErrorCode::io_failed, "cannot append to '" + file.string() +
                                           "': " + std::generic_category().message(errno));
}

}  // namespace

Result<ResultLog> parse_results(std::string_view text, const std::string& name, Reruns reruns) {
  LogBuilder builder(reruns);
  const auto added = builder.add_file(text, name);
  if (!added) return tl::unexpected(added.error());
  return builder.finish();
}

Result<ResultLog> read_results(std::span<const std::filesystem::path> files, Reruns reruns) {
  LogBuilder builder(reruns);
  for (const std::filesystem::path& file : files) {
    const auto text = read_file(file);
    if (!text) return tl::unexpected(text.error());
    const auto added = builder.add_file(*text, file.string());
    if (!added) return tl::unexpected(added.error());
  }
  return builder.finish();
}

Result<void> append_result(const std::filesystem::path& file, std::string_view line,
                           Reruns reruns) {
  while (line.ends_with('\n') || line.ends_with('\r')) line.remove_suffix(1);
  if (line.find('\n') != std::string_view::npos) {
    return failure(ErrorCode::malformed, "the result to append: more than one line");
  }
  const auto result = parse_case_result(line, "the result to append");
  if (!result) return tl::unexpected(result.error());

  const LockedFile locked(file);
  if (!locked.is_open()) return cannot_append(file);
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  const std::size_t last_feed = text->rfind('\n');
  const std::size_t whole = last_feed == std::string::npos ? 0 : last_feed + 1;
  const std::string added = std::string(line) + "\n";
  const auto log = parse_results(text->substr(0, whole) + added, file.string(), reruns);
  if (!log) return tl::unexpected(log.error());
  if (!locked.replace_tail(whole, added)) return cannot_append(file);
  return {};
}

Result<std::vector<std::string>> cases_in(const std::filesystem::path& population) {
  auto cases = names_in(population);
  if (!cases) return cases;
  std::erase_if(*cases, [&](const std::string& name) {
    return !std::filesystem::exists(population / name / "site.toml");
  });
  if (cases->empty()) {
    return failure(ErrorCode::not_found,
                   "no case (a folder with a site.toml) in '" + population.string() + "'");
  }
  return cases;
}

Result<PendingCases> pending_cases(const std::filesystem::path& population,
                                   const std::filesystem::path& results,
                                   const std::string& method) {
  auto cases = cases_in(population);
  if (!cases) return tl::unexpected(cases.error());
  if (!std::filesystem::exists(results)) return PendingCases{.cases = std::move(*cases)};

  auto log = read_results({&results, 1}, Reruns::replace);
  if (!log) return tl::unexpected(log.error());
  std::set<std::string> done;
  for (const CaseResult& result : log->results) {
    if (result.method == method) done.insert(result.case_id);
  }
  std::erase_if(*cases, [&](const std::string& name) { return done.contains(name); });
  return PendingCases{.cases = std::move(*cases), .torn = std::move(log->torn)};
}

}  // namespace recald::blind
