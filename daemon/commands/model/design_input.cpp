#include "daemon/commands/model/design_input.hpp"

#include <utility>

#include "adapters/system/files/write_file.hpp"
#include "daemon/site/calibrate/design_outliers.hpp"

namespace recald::daemon {

tl::expected<doe::DesignFolder, int> open_design_folder(const DesignArguments& arguments,
                                                        const Console& console) {
  auto design = doe::read_design_folder(arguments.folder, arguments.design);
  if (!design) return tl::unexpected(console.fail(design.error()));
  for (std::string& note : set_aside_outliers(*design)) design->notes.push_back(std::move(note));
  return std::move(*design);
}

MetamodelOptions metamodel_options(const DesignArguments& arguments, std::uint64_t seed) {
  MetamodelOptions options;
  if (arguments.form == "seed") options.form = MetamodelForm::seed;
  if (arguments.form == "monthly") options.form = MetamodelForm::monthly;
  options.wind_in_degrees = arguments.wind_direction == "degrees";
  options.seed = seed;
  return options;
}

Result<void> write_result(const std::filesystem::path& folder, const char* name,
                          const std::string& text) {
  if (folder.empty()) return {};
  if (auto made = system::make_folder(folder); !made) return made;
  return system::write_file(folder / name, text);
}

}  // namespace recald::daemon
