#include "tests/blind/population/seal.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <vector>

#include "adapters/system/files/sha256.hpp"
#include "adapters/system/files/write_file.hpp"

namespace recald::blind {
namespace {

std::string hash_of(std::string_view bytes) {
  system::Sha256 digest;
  digest.add(bytes);
  return digest.hex();
}

}  // namespace

Result<std::string> seal_answers(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  if (files.empty()) {
    return failure(ErrorCode::not_found, "no answers (<case>.json) in '" + folder.string() + "'");
  }
  std::ranges::sort(files);
  std::string lines;
  for (const std::filesystem::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!in) return failure(ErrorCode::io_failed, "cannot read '" + file.string() + "'");
    lines += hash_of(text) + "  " + file.filename().string() + "\n";
  }
  const std::string whole = hash_of(lines);
  auto written = system::write_file(folder / "answers.sha256", lines + "# whole " + whole + "\n");
  if (!written) return tl::unexpected(written.error());
  return whole;
}

}  // namespace recald::blind
