#include "tests/blind/scoring/seal.hpp"

#include <date/date.h>
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "adapters/system/sha256.hpp"
#include "adapters/system/write_file.hpp"
#include "tests/blind/scoring/answers.hpp"
#include "tests/blind/scoring/files.hpp"
#include "tests/blind/scoring/json_fields.hpp"

namespace recald::blind {
namespace {

constexpr const char* kSeal = "answers.sha256";
constexpr const char* kOpened = "opened.json";
constexpr std::string_view kWhole = "# whole ";

bool is_hash(std::string_view text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

struct Seal {
  std::map<std::string, std::string> hash_of_file;
  std::string whole;
  std::string lines;  ///< What the whole is the hash of.
};

Result<Seal> parse_seal(std::string_view text, const std::filesystem::path& file) {
  Seal seal;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string line{text.substr(0, end)};
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.starts_with(kWhole) && text.empty()) {
      seal.whole = line.substr(kWhole.size());
      break;
    }
    if (line.size() < 67 || !is_hash(line.substr(0, 64)) || line.substr(64, 2) != "  ") {
      return failure(ErrorCode::malformed, fmt::format("{} line {}: not '<64 hex digits>  <file>'",
                                                       file.string(), number));
    }
    seal.hash_of_file[line.substr(66)] = line.substr(0, 64);
    seal.lines += line + "\n";
  }
  if (!is_hash(seal.whole)) {
    return failure(
        ErrorCode::malformed,
        fmt::format("{}: the last line must be '{}<64 hex digits>'", file.string(), kWhole));
  }
  return seal;
}

Result<void> check_files(const Seal& seal, const std::filesystem::path& folder) {
  for (const auto& [name, hash] : seal.hash_of_file) {
    const auto text = read_file(folder / name);
    if (!text) return tl::unexpected(text.error());
    if (hash_of(*text) != hash) {
      return failure(ErrorCode::invalid_value,
                     fmt::format("{}: the answer was changed after it was sealed; not opened",
                                 (folder / name).string()));
    }
  }
  const auto names = answer_files(folder);
  if (!names) return tl::unexpected(names.error());
  for (const std::string& name : *names) {
    if (!seal.hash_of_file.contains(name)) {
      return failure(
          ErrorCode::invalid_value,
          fmt::format("{}: the answer was added after the others were sealed; not opened",
                      (folder / name).string()));
    }
  }
  return {};
}

Result<nlohmann::json> read_openings(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kOpened;
  if (!std::filesystem::exists(file)) return nlohmann::json::array();
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  auto openings = parse_json(*text, file.string());
  if (!openings) return openings;
  const bool readable =
      openings->is_array() && std::ranges::all_of(*openings, [](const nlohmann::json& opening) {
        return opening.is_object() && opening.contains("opened_at") &&
               opening["opened_at"].is_string();
      });
  if (!readable) {
    return failure(ErrorCode::malformed,
                   file.string() + ": must be a list of openings, each with 'opened_at'");
  }
  return openings;
}

}  // namespace

Result<std::string> seal_answers(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kSeal;
  if (std::filesystem::exists(file)) {
    return failure(ErrorCode::invalid_value,
                   file.string() + ": sealed already; a second seal would hide a change");
  }
  const auto names = answer_files(folder);
  if (!names) return tl::unexpected(names.error());
  std::string lines;
  for (const std::string& name : *names) {
    const auto text = read_file(folder / name);
    if (!text) return tl::unexpected(text.error());
    lines += hash_of(*text) + "  " + name + "\n";
  }
  const std::string whole = hash_of(lines);
  const auto written = system::write_file(file, lines + std::string(kWhole) + whole + "\n");
  if (!written) return tl::unexpected(written.error());
  return whole;
}

Result<std::string> verify_seal(const std::filesystem::path& folder,
                                const std::optional<std::string>& published) {
  const std::filesystem::path file = folder / kSeal;
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  const auto seal = parse_seal(*text, file);
  if (!seal) return tl::unexpected(seal.error());
  if (hash_of(seal->lines) != seal->whole) {
    return failure(ErrorCode::invalid_value,
                   file.string() + ": its last line is not the hash of the others; not opened");
  }
  if (published && *published != seal->whole) {
    return failure(ErrorCode::invalid_value,
                   fmt::format("{}: the whole is {}, but {} was published; not opened",
                               file.string(), seal->whole, *published));
  }
  const auto checked = check_files(*seal, folder);
  if (!checked) return tl::unexpected(checked.error());
  return seal->whole;
}

Result<std::vector<std::string>> earlier_openings(const std::filesystem::path& folder) {
  const auto openings = read_openings(folder);
  if (!openings) return tl::unexpected(openings.error());
  std::vector<std::string> instants;
  for (const nlohmann::json& opening : *openings) {
    instants.push_back(opening["opened_at"].get<std::string>());
  }
  return instants;
}

Result<void> record_opening(const std::filesystem::path& folder, const Opening& opening) {
  auto openings = read_openings(folder);
  if (!openings) return tl::unexpected(openings.error());
  openings->push_back({{"opened_at", date::format("%FT%TZ", opening.at)},
                       {"scorer", opening.scorer_version},
                       {"whole_sha256", opening.whole_hash},
                       {"results_sha256", opening.results_hash},
                       {"cases_of_version", opening.cases_of_version}});
  return system::write_file(folder / kOpened, openings->dump(2) + "\n");
}

std::string hash_of(std::string_view bytes) {
  system::Sha256 digest;
  digest.add(bytes);
  return digest.hex();
}

}  // namespace recald::blind
