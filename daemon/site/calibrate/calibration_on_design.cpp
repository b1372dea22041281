#include "daemon/site/calibrate/calibration_on_design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "adapters/system/files/sha256.hpp"
#include "core/absent.hpp"
#include "core/display/warning.hpp"
#include "daemon/site/calibrate/design_origin.hpp"
#include "daemon/site/calibrate/design_outliers.hpp"
#include "daemon/site/calibrate/design_plan.hpp"
#include "daemon/site/model/active_effects.hpp"

namespace recald::daemon {

Result<doe::Measurements> measurements_for(const doe::DesignFolder& design,
                                           const PreparedSite& site) {
  const doe::MonthlyTable all = measured_table(site);
  doe::Measurements measured;
  measured.table.names = design.output_names;
  std::vector<Eigen::Index> rows;
  std::string beyond;
  for (std::size_t m = 0; m < all.months.size(); ++m) {
    if (design.inputs.row_of(all.months[m]) >= 0) {
      rows.push_back(static_cast<Eigen::Index>(m));
      measured.table.months.push_back(all.months[m]);
    } else {
      beyond += (beyond.empty() ? "" : ", ") + all.months[m].text();
    }
  }
  const bool covers_any = std::ranges::any_of(measured.table.months, [&](doe::DesignMonth month) {
    return std::ranges::find(design.months, month) != design.months.end();
  });
  if (!covers_any) {
    return failure(
        ErrorCode::not_enough_data,
        fmt::format("the design in {} covers none of the site's months; run `recald doe` "
                    "again",
                    design.folder.string()));
  }
  measured.table.values.setConstant(static_cast<Eigen::Index>(rows.size()),
                                    static_cast<Eigen::Index>(design.output_names.size()), kAbsent);
  bool has_any = false;
  for (std::size_t k = 0; k < design.output_names.size(); ++k) {
    const auto column = std::ranges::find(all.names, design.output_names[k]);
    if (column == all.names.end()) continue;
    has_any = true;
    measured.table.values.col(static_cast<Eigen::Index>(k)) =
        all.values(rows, column - all.names.begin());
  }
  if (!has_any) {
    return failure(ErrorCode::unsupported,
                   fmt::format("the site measures none of the outputs of the design in {} ({})",
                               design.folder.string(), fmt::join(design.output_names, ", ")));
  }
  if (!beyond.empty()) {
    measured.notes.push_back("the design has no model inputs for " + beyond +
                             "; run `recald doe` again to use them");
  }
  return measured;
}

Result<FinishedDesign> calibrate_on_metamodel(const ModelledSite& modelled,
                                              const std::filesystem::path& folder,
                                              const calibration::RunContext& context) {
  auto design = TRY(doe::read_design_folder(folder));
  for (std::string& note : set_aside_outliers(design)) design.notes.push_back(std::move(note));
  const auto origin = TRY(check_origin(design));
  const SiteConfig& site = modelled.site.config;
  std::error_code ignored;
  const bool is_others = !origin.site_file.empty() &&
                         !std::filesystem::equivalent(origin.site_file, site.file, ignored);
  if (is_others) {
    return failure(ErrorCode::unsupported,
                   fmt::format("the design in {} was run for {} and not for this site; run `recald "
                               "doe` for it",
                               folder.string(), origin.site_file.string()));
  }
  auto version = TRY(active_version(site));
  const auto prepared = TRY(prepare_site(site, modelled.site.calendar, modelled.recording,
                                         modelled.weather, std::move(version.effects)));
  const auto measured = TRY(measurements_for(design, prepared));
  const auto design_facts = TRY(facts_of_files(design.files, name_of(ModelKind::metamodel)));
  system::Sha256 both;
  both.add(modelled.facts.data_revision);
  both.add(design_facts.data_revision);
  FinishedDesign done{
      .name = site.name, .design = std::move(design), .calibration = {}, .facts = modelled.facts};
  done.facts.data_revision = both.hex();
  done.facts.model_version = design_facts.model_version;
  done = TRY(finish_calibration(std::move(done), origin, measured, {}, context));
  display::add_notes(measured.notes, done.calibration.warnings);
  return done;
}

}  // namespace recald::daemon
