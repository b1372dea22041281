#include "adapters/energyplus/trial.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <optional>

#include "adapters/energyplus/run/meter_output.hpp"
#include "adapters/system/files/sha256.hpp"
#include "adapters/system/files/write_file.hpp"

namespace recald::energyplus {
namespace {

constexpr std::size_t kNameDigits = 20;

std::string name_of_trial(const ModelDocument& model, const std::vector<std::string>& meters,
                          const Program& program) {
  system::Sha256 digest;
  digest.add(model.objects.dump());
  digest.add(program.version);
  for (const std::string& meter : meters) digest.add("\n" + meter);
  return "tried-" + digest.hex().substr(0, kNameDigits);
}

std::optional<TriedModel> kept_trial(const std::filesystem::path& file,
                                     const std::string& version) {
  std::ifstream in{file};
  if (!in) return {};
  Json kept = Json::parse(in, nullptr, /*allow_exceptions=*/false);
  if (!kept.is_object() || !kept.contains("objects") || !kept.contains("left")) return {};
  TriedModel tried{{std::move(kept["objects"]), version}, {}};
  tried.sizes.frozen = kept.value("frozen", 0);
  for (const Json& left : kept["left"]) {
    if (left.is_string()) tried.sizes.left.push_back(left.get<std::string>());
  }
  return tried;
}

}  // namespace

Result<TriedModel> try_model(const ModelDocument& model, const std::vector<std::string>& meters,
                             metering::Day day, const std::filesystem::path& weather,
                             const std::filesystem::path& folder, const Program& program,
                             const RunLimits& limits, const std::function<bool()>& keep_going) {
  const std::string name = name_of_trial(model, meters, program);
  const std::filesystem::path kept = folder / (name + ".json");
  if (auto tried = kept_trial(kept, model.version)) return std::move(*tried);
  TRY(system::make_folder(folder));
  Json prepared = model.objects;
  prepare_objects({.first = day, .last = day, .meters = meters}, prepared);
  const auto sql = TRY(simulate(
      prepared, weather, folder / name, program, limits,
      keep_going ? keep_going : [] { return true; }));
  TRY(read_meters(sql, meters, {}));
  const auto sizes = TRY(read_component_sizes(sql));
  TriedModel tried{model, {}};
  tried.sizes = freeze_sizes(sizes, tried.model.objects);
  const Json outcome = {
      {"frozen", tried.sizes.frozen}, {"left", tried.sizes.left}, {"objects", tried.model.objects}};
  TRY(system::write_file(kept, outcome.dump()));
  std::error_code ignored;
  std::filesystem::remove_all(folder / name, ignored);
  return tried;
}

}  // namespace recald::energyplus
