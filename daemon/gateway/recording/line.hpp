/// A recording, line by line: what a gateway began with, then what came in, as JSON. README.md in
/// this folder describes each line.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "adapters/ports/store.hpp"
#include "core/result.hpp"
#include "daemon/gateway/recording/entry.hpp"

namespace recald::daemon::recording {

inline constexpr int kFormat = 1;  ///< Raised when an older recald would take lines wrongly.
/// Of one line. What may be longer is divided: texts and lists of readings.
inline constexpr std::size_t kTextMax_bytes = 8'000;
inline constexpr std::size_t kReadingsMax = 400;
/// Of a whole line. A counter's state has each read of the interval that is open.
inline constexpr std::size_t kLineMax_bytes = 1'000'000;

/// The first line.
struct Head {
  int format;
  std::string program;  ///< Version that recorded.
  std::string time_zone_release;
};

/// A part of the text of the site file, or of a register map that it names. Parts of the same name
/// follow each other.
struct SitePart {
  std::string map;  ///< As the site file calls it; empty: the site file.
  std::string text;
};

/// A meter as the store knew it at the start.
struct KnownMeter {
  std::string id;
  std::chrono::seconds interval;
  std::string rules;  ///< By which its months were closed.
  /// Older readings were stored, and are not in the recording; absent: there were none.
  std::optional<metering::Instant> readings_from = {};
};

struct KnownRegister {
  std::string meter;
  RegisterState state;
};

/// Readings that the store had at the start, or that the push that follows has too.
struct Readings {
  std::string meter;
  std::vector<metering::Reading> readings;
};

/// What had happened within the last day, which is counted further, and which meters were silent.
struct KnownEvent {
  StoreEvent event;
};

struct KnownMonth {
  std::string meter;
  StoredMonth month;
};

struct ReopenedMonth {
  std::string meter;
  metering::Month month;
};

/// Intervals as the gateway has committed them: what a replay is compared with.
struct Committed {
  std::string meter;
  std::vector<metering::Reading> readings;
};

/// The last line, unless the process was killed.
struct End {
  std::string why;
  bool is_whole;  ///< With all that the gateway has committed.
};

using Line = std::variant<Head, SitePart, KnownMeter, KnownRegister, Readings, KnownEvent,
                          KnownMonth, ReopenedMonth, Entry, Committed, End>;

/// As JSON, with a line end; numbers as they are, so that parsing gives the same.
[[nodiscard]] std::string to_text(const Line& line);

/// @return malformed with a sentence: no JSON, an unknown kind of line, a field that is missing or
///         of another kind; unsupported for a head of a newer format.
[[nodiscard]] Result<Line> parse_line(std::string_view text);

}  // namespace recald::daemon::recording
