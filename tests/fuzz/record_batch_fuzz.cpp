// A batch or a watermark is refused with a reason, or is the same when written and read again.
#include "adapters/record/record_batch.hpp"
#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

void require_rising(std::int64_t after, const auto& all) {
  for (const auto& one : all) {
    require(one.number > after, "numbers rise");
    after = one.number;
  }
}

/// @return what was read; nothing if it was refused.
template <class Read>
auto read_again(std::string_view text, Read read) {
  const auto first = read(text);
  if (!first) {
    require_sentence(first.error().message);
    return first;
  }
  const std::string written = record::to_json(*first);
  const auto second = read(written);
  require(second.has_value(), "what was written can be read");
  require(record::to_json(*second) == written, "and is the same");
  return first;
}

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald::fuzz;
  const std::string_view text = text_of(data, size);
  (void)read_again(text, recald::record::parse_watermark);
  const auto batch = read_again(text, recald::record::parse_batch);
  if (!batch) return 0;
  require_rising(batch->after.entries, batch->entries);
  require_rising(batch->after.events, batch->events);
  require_rising(batch->after.results, batch->results);
  return 0;
}
