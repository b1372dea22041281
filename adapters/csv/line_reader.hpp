/// Reads the lines of a text of any length through one buffer of fixed size.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace recald::csv {

inline constexpr std::size_t kLineMax = 65'536;  ///< Bytes; a longer line is a bad line.

/// Fills the buffer with up to `size` bytes and returns how many; 0 at the end.
using ByteSource = std::function<Result<std::size_t>(char* buffer, std::size_t size)>;

struct Line {
  std::string_view text;  ///< Without its line end; valid until the next call.
  std::uint64_t number;   ///< From 1.
  bool terminated;        ///< False for a last line without a line end.
  bool too_long;          ///< Then `text` is empty.
};

/// Accepts LF and CRLF; drops a UTF-8 byte order mark before the first line.
class LineReader {
 public:
  /// @param line_max  Bytes of a line.
  explicit LineReader(ByteSource source, std::size_t line_max = kLineMax);

  /// @return false at the end, and when the source fails; then `error` says why.
  bool next(Line& line);
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  bool refill();
  bool skip_long_line(Line& line);
  bool last_line(Line& line);
  void deliver(Line& line, const char* end, bool terminated);

  ByteSource source_;
  std::size_t line_max_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t number_ = 0;
  std::optional<Error> error_;
};

/// @return a source of the file's bytes; or not_found or io_failed, naming the file as `what`.
[[nodiscard]] Result<ByteSource> open_file(const std::filesystem::path& file,
                                           std::string_view what);

/// A source of the bytes of `text`, which must outlive it.
[[nodiscard]] ByteSource bytes_of(std::string_view text);

}  // namespace recald::csv
