#include "adapters/energyplus/read_model.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>

#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "adapters/system/child_process.hpp"
#include "adapters/system/files/regular_file.hpp"
#include "adapters/system/files/scratch_folder.hpp"
#include "core/text/ascii.hpp"

namespace recald::energyplus {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::minutes kLongest{5};

std::string file_text(const fs::path& file) {
  std::ifstream in{file, std::ios::binary};
  return {std::istreambuf_iterator<char>{in}, {}};
}

/// A helper of EnergyPlus in the scratch folder, which looks for its own data beside it. Packages
/// may leave one without the right to be run, so a copy runs.
Result<void> run_helper(std::string_view name, const std::vector<std::string>& arguments,
                        const Program& program, const fs::path& folder) {
  const fs::path original = program.folder() / name;
  std::error_code failed;
  const fs::path helper = folder / name;
  fs::copy_file(original, helper, fs::copy_options::overwrite_existing, failed);
  if (failed) {
    return failure(ErrorCode::io_failed,
                   fmt::format("{} is needed to read an IDF and cannot be copied: {}; convert the "
                               "model to epJSON, or install EnergyPlus whole",
                               original.string(), failed.message()));
  }
  fs::permissions(helper, fs::perms::owner_all, fs::perm_options::add, failed);
  for (const auto& entry : fs::directory_iterator{program.folder(), failed}) {
    const std::string file = entry.path().filename().string();
    if (file.starts_with("Energy+") || file.find(".so") != std::string::npos) {
      fs::create_symlink(entry.path(), folder / file, failed);
    }
  }
  const fs::path output = folder / "said.txt";
  const auto ended = TRY(system::run_child({.program = helper,
                                            .arguments = arguments,
                                            .folder = folder,
                                            .output = output,
                                            .time_max = kLongest},
                                           {}));
  if (ended.ending == system::Ending::exited && ended.exit_code == 0) return {};
  std::string words = file_text(output).substr(0, 400);
  std::ranges::replace_if(
      words, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return failure(ErrorCode::io_failed,
                 fmt::format("{} failed and said: {}", original.string(), words));
}

Result<ModelDocument> convert(const fs::path& file, const Program& program) {
  TRY(system::require_file(file, "EnergyPlus model"));
  const auto scratch = TRY(system::ScratchFolder::make());
  const fs::path& folder = scratch.path();
  fs::path idf = folder / "in.idf";
  std::error_code failed;
  fs::copy_file(file, idf, failed);
  if (failed) {
    return failure(ErrorCode::io_failed,
                   fmt::format("'{}' cannot be copied: {}", file.string(), failed.message()));
  }
  if (to_lower(file_text(idf)).find("hvactemplate:") != std::string::npos) {
    TRY(run_helper("ExpandObjects", {}, program, folder));
    const fs::path expanded = folder / "expanded.idf";
    if (fs::exists(expanded, failed)) fs::rename(expanded, idf, failed);
  }
  TRY(run_helper("ConvertInputFormat", {"in.idf"}, program, folder));
  const fs::path converted = folder / "in.epJSON";
  if (!fs::exists(converted, failed)) {
    return failure(ErrorCode::malformed,
                   fmt::format("EnergyPlus's converter cannot read '{}'; it reported: {}",
                               file.string(), file_text(folder / "said.txt").substr(0, 400)));
  }
  return parse_epjson(file_text(converted), file.string());
}

std::string_view year_of(std::string_view version) { return version.substr(0, version.find('.')); }

}  // namespace

Result<ModelDocument> read_model(const fs::path& file, const Program& program) {
  const bool is_idf = equals_ignoring_case(file.extension().string(), ".idf");
  auto document = is_idf ? convert(file, program) : read_epjson(file);
  if (!document || document->version == program.version) return document;
  if (year_of(document->version) != year_of(program.version)) {
    return failure(
        ErrorCode::unsupported,
        fmt::format("'{}' is a model of EnergyPlus {} and the program is {}; bring the model to "
                    "that release with EnergyPlus's IDFVersionUpdater, or name the program of its "
                    "own release",
                    file.string(), document->version, program.version));
  }
  for (auto& [name, fields] : document->objects["Version"].items()) {
    fields["version_identifier"] = program.version;
  }
  document->version = program.version;
  return document;
}

}  // namespace recald::energyplus
