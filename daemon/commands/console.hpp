/// How a command talks: data on one stream, words for people on the other.
#pragma once

#include <chrono>
#include <istream>
#include <mutex>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "core/calibration/calibration.hpp"
#include "core/result.hpp"

namespace recald::daemon {

/// Begins the present line of a terminal again.
inline constexpr std::string_view kLineOver = "\r\033[K";

inline constexpr int kSuccess = 0;
inline constexpr int kFailure = 1;  ///< Explained in one line.
inline constexpr int kUsage = 2;

struct Console {
  enum class Detail { little, usual, all };

  std::ostream& out;  ///< Data.
  std::ostream& err;  ///< Words.
  bool is_terminal;   ///< Of `err`: progress is drawn only for people.
  Detail detail = Detail::usual;
  std::istream* answers = nullptr;  ///< Of a person who can be asked; null: nobody is there.

  /// "recald: …" on err; returns kFailure.
  int fail(const std::string& sentence) const;
  int fail(const Error& error) const { return fail(error.message); }
  int fail(const std::vector<std::string>& sentences) const;
  /// The same for options that make no sense; returns kUsage.
  int misused(const std::string& sentence) const;
};

/// "12 s", "3 min", "2 h"; empty for what nobody can know yet.
[[nodiscard]] std::string time_left_text(double elapsed_s, double share);

/// One line on a terminal that is drawn over itself, at most once a per cent, with the time left.
/// Safe from any thread.
class ProgressLine {
 public:
  explicit ProgressLine(const Console& console) : console_(console) {}
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const calibration::Progress& progress);
  /// @param share  Of the work named `what`.
  void show(std::string_view what, double share);

 private:
  void draw(std::string_view what, double share);

  const Console& console_;
  std::mutex mutex_;
  std::vector<int> done_;  ///< By chain.
  std::string what_;
  std::chrono::steady_clock::time_point begin_;  ///< Of `what_`.
  int shown_percent_ = -1;
};

}  // namespace recald::daemon
