// A workbook is read as rows, or refused with a sentence, in a time that grows as it does: its
// parts refer to each other, and lie in each other, as often as a file likes.
#include <unistd.h>

#include <array>
#include <chrono>

#include "adapters/table/xlsx.hpp"
#include "tests/fuzz/require.hpp"
#include "tests/support/zip_file.hpp"

namespace recald::fuzz {
namespace {

constexpr std::array kParts{"xl/workbook.xml", "xl/_rels/workbook.xml.rels", "xl/s.xml",
                            "xl/styles.xml", "xl/sharedStrings.xml"};
constexpr int kTimes = 20'000;  // so that the square of what is repeated shows
constexpr std::chrono::seconds kLongest{5};

/// What stands between \x01 and \x02 many times over, once in a part.
std::string unfolded(std::string_view text) {
  const std::size_t begin = text.find('\x01');
  const std::size_t end = text.find('\x02', begin == std::string_view::npos ? 0 : begin);
  if (begin == std::string_view::npos || end == std::string_view::npos) return std::string{text};
  std::string all{text.substr(0, begin)};
  for (int i = 0; i < kTimes; ++i) all += text.substr(begin + 1, end - begin - 1);
  return all.append(text.substr(end + 1));
}

}  // namespace
}  // namespace recald::fuzz

/// Parts in the order of `kParts`, with a zero between them.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald;
  using namespace recald::fuzz;
  constexpr std::size_t kLengthMax = 1'000;
  if (size > kLengthMax) return 0;
  std::string_view rest = text_of(data, size);
  std::map<std::string, std::string> entries;
  for (const char* part : kParts) {
    const std::size_t end = std::min(rest.find('\0'), rest.size());
    if (end > 0) entries[part] = unfolded(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (entries.empty()) return 0;
  const std::string made = "/tmp/recald-workbook-" + std::to_string(::getpid());
  recald::testing::write_zip(made, entries);
  const auto begin = std::chrono::steady_clock::now();
  const auto rows = table::open_sheet(made, "");
  std::filesystem::remove(made);
  if (!rows) {
    require_sentence(rows.error().message);
  } else {
    std::uint64_t count = 0;
    for (table::TableRow row; (*rows)->next(row);) ++count;
    require(count <= size * kTimes, "a row has bytes");
  }
  require(std::chrono::steady_clock::now() - begin < kLongest, "it takes no longer than its size");
  return 0;
}
