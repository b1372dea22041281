/// What a terminal gets: what others have written must not move its cursor, change its colours or
/// turn the direction of writing.
#pragma once

#include <streambuf>

namespace recald::daemon {

/// Passes texts on to another buffer, with control characters written out; lines, tabs, and the
/// drawing of a line over itself (ProgressLine) stay.
class TerminalText final : public std::streambuf {
 public:
  explicit TerminalText(std::streambuf& to) : to_(to) {}

 protected:
  std::streamsize xsputn(const char* text, std::streamsize count) override;
  int_type overflow(int_type character) override;
  int sync() override { return to_.pubsync(); }

 private:
  std::streambuf& to_;
};

}  // namespace recald::daemon
