#include "adapters/doe/failed_runs_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "adapters/doe/table_reader.hpp"
#include "adapters/system/files/write_file.hpp"

namespace recald::doe {
namespace {

constexpr const char* kFailedFile = "failed.csv";

}  // namespace

Result<std::map<int, std::string>> read_failed_runs(const std::filesystem::path& folder) {
  std::map<int, std::string> failed;
  const std::filesystem::path file = folder / kFailedFile;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return failed;
  auto table = TRY(TableReader::open(file));
  for (const char* column : {"run", "because"}) {
    TRY(table.require(column));
  }
  for (;;) {
    const auto more = TRY(table.next());
    if (!more) return failed;
    const auto run = TRY(table.whole_number(*table.find("run")));
    failed[run] = table.text(*table.find("because"));
  }
}

Result<void> write_failed_runs(const std::filesystem::path& folder,
                               const std::map<int, std::string>& failed) {
  const std::filesystem::path file = folder / kFailedFile;
  if (failed.empty()) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    return {};
  }
  std::string text = "run,because\n";
  for (const auto& [run, because] : failed) {
    std::string words = because;  // a sentence of another program, kept to one plain field
    std::ranges::replace_if(
        words, [](char c) { return c == ',' || c == '"' || c == '\n'; }, ' ');
    text += fmt::format("{},{}\n", run, words);
  }
  return system::write_file(file, text);
}

}  // namespace recald::doe
