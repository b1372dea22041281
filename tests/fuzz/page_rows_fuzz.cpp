// Whatever bytes the pages of a store have: reading their rows ends, and no value is longer than
// all the bytes that there are.
#include <algorithm>
#include <vector>

#include "adapters/sqlite/recovery/page_rows.hpp"
#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

constexpr std::size_t kPage = 4096;

/// Some pages: the input's bytes in turn, the rest zeros.
std::vector<std::vector<std::uint8_t>> pages_of(const std::uint8_t* data, std::size_t size) {
  std::vector<std::vector<std::uint8_t>> pages;
  for (std::size_t at = 0; at < size; at += kPage) {
    pages.emplace_back(data + at, data + std::min(at + kPage, size));
    pages.back().resize(kPage);
  }
  return pages;
}

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald::fuzz;
  const auto pages = pages_of(data, size);
  const auto page_of = [&](std::uint32_t number) {
    return number == 0 || number > pages.size() ? std::vector<std::uint8_t>{} : pages[number - 1];
  };
  for (std::size_t i = 0; i < pages.size(); ++i) {
    for (const auto& row : recald::sqlite::rows_on_page(pages[i], i == 0, page_of)) {
      require(row.values.size() <= 64, "a row has so many values at most");
      for (const auto& value : row.values) {
        require(value.text.size() <= pages.size() * kPage, "a text is no longer than its bytes");
      }
    }
  }
  return 0;
}
