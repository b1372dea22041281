// A line of a recording is refused with a reason, or is the same when written and read again.
#include "daemon/gateway/recording/line.hpp"
#include "tests/fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald::fuzz;
  using namespace recald::daemon;
  const auto line = recording::parse_line(text_of(data, size));
  if (!line) {
    require_sentence(line.error().message);
    return 0;
  }
  const std::string written = recording::to_text(*line);
  const auto again = recording::parse_line(written);
  require(again.has_value(), "what was written can be read");
  require(again->index() == line->index(), "as the same kind of line");
  require(recording::to_text(*again) == written, "and is the same");
  return 0;
}
