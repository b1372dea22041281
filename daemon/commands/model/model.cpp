#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "adapters/models/model_store.hpp"
#include "adapters/models/version_file.hpp"
#include "adapters/views/frame/format.hpp"
#include "core/display/id_words.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/model/version_list.hpp"

namespace recald::daemon {
namespace {

using diagnosis::AddedEffect;
using diagnosis::ModelVersion;
using diagnosis::short_version;
using Json = nlohmann::ordered_json;

constexpr double kRivalWorthALine = 0.005;  // what rounds to 0 % is no rival

/// @return the store of the site, or the exit code after saying what is wrong with the site file.
tl::expected<models::ModelStore, int> open_store(const ModelArguments& arguments,
                                                 const Console& console) {
  const auto site = load_site(arguments.site);
  if (!site) return tl::unexpected(console.fail(site.error()));
  return models::ModelStore{site->versions_beside(), site->id};
}

std::string effects_words(const ModelVersion& version) {
  return version.effects.empty() ? "no effects"
                                 : fmt::format("{}", fmt::join(effect_ids(version), ", "));
}

std::string list_words(const models::VersionList& list) {
  std::string text;
  for (const ModelVersion& version : list.versions) {
    text += fmt::format("{} {:<12}  {:<8}  {:<20}  {}\n",
                        version.version == list.active ? '*' : ' ', short_version(version.version),
                        name_of(version.status), version.created_at, effects_words(version));
  }
  return text;
}

std::string period_words(const AddedEffect& added) {
  std::string words;
  if (added.from) words += " from " + metering::to_string(*added.from);
  if (added.to) words += " until " + metering::to_string(*added.to);
  return words;
}

std::string effect_words(const AddedEffect& added) {
  std::string text = fmt::format("\n{} ({}){}{}\n  {}\n", added.title, added.effect,
                                 added.meter.empty() ? "" : ", meter " + added.meter,
                                 period_words(added), added.physics);
  text += fmt::format("  probability {}, evidence gain {:.1f} nats\n",
                      views::probability_text(added.probability), added.log_evidence_gain);
  for (const auto& rival : added.rivals) {
    if (rival.probability < kRivalWorthALine) continue;
    text += fmt::format("  rival: {} {:.0f} %\n", rival.effect, 100.0 * rival.probability);
  }
  for (const auto& p : added.parameters) {
    text +=
        fmt::format("  {} [{}]: {:.4g} ± {:.2g}, 90 % {:.4g} to {:.4g}; prior {} {:.4g} ± {:.2g}\n",
                    p.name, p.unit, p.mean, p.sd, p.q05, p.q95, p.prior.name(), p.prior.mean(),
                    std::sqrt(p.prior.variance()));
  }
  for (const auto& impact : added.impacts) {
    text += fmt::format("  {}: {:+.0f} kWh a month\n", display::meter_label(impact.meter),
                        impact.monthly_kWh);
  }
  if (!added.months_used.empty()) {
    text += fmt::format("  learned from {} months, {} to {}\n", added.months_used.size(),
                        metering::to_string(added.months_used.front()),
                        metering::to_string(added.months_used.back()));
  }
  return text;
}

std::string version_words(const ModelVersion& version) {
  if (version.version == diagnosis::kBaseVersion) {
    return "drawings: the model as described in the site file, without effects\n";
  }
  std::string text =
      fmt::format("{}, {} ({}), made {}\nparent {}, data {}, catalogue {}\n",
                  short_version(version.version), name_of(version.status), name_of(version.author),
                  version.created_at, short_version(version.parent),
                  short_version(version.data_revision), version.catalogue_version);
  for (const AddedEffect& added : version.effects) text += effect_words(added);
  return text;
}

std::string now_text() {
  return metering::to_string(
      std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now()));
}

/// @param how  "back"
int report_change(const ModelArguments& arguments, const Console& console,
                  const ModelVersion& version, std::string_view how) {
  if (arguments.json) {
    const Json json = {{"active", version.version}, {"effects", effect_ids(version)}};
    console.out << json.dump(2) + "\n";
  } else {
    console.out << fmt::format("The model is {} at version {}, with {}.\n", how,
                               short_version(version.version), effects_words(version));
  }
  return kSuccess;
}

}  // namespace

int run_model_list(const ModelArguments& arguments, const Console& console) {
  const auto store = open_store(arguments, console);
  if (!store) return store.error();
  const auto list = store->list();
  if (!list) return console.fail(list.error());
  for (const std::string& sentence : list->damaged) console.err << "! " << sentence << "\n";
  console.out << (arguments.json ? versions_json(*list).dump(2) + "\n" : list_words(*list));
  return kSuccess;
}

int run_model_show(const ModelArguments& arguments, const Console& console) {
  const auto store = open_store(arguments, console);
  if (!store) return store.error();
  const auto version = arguments.version.empty() ? store->active() : store->load(arguments.version);
  if (!version) return console.fail(version.error());
  console.out << (arguments.json ? models::version_json(*version) : version_words(*version));
  return kSuccess;
}

int run_model_apply(const ModelArguments& arguments, const Console& console) {
  const auto store = open_store(arguments, console);
  if (!store) return store.error();
  const auto version = store->activate(arguments.version, now_text());
  if (!version) return console.fail(version.error());
  return report_change(arguments, console, *version, "now");
}

int run_model_revert(const ModelArguments& arguments, const Console& console) {
  const auto store = open_store(arguments, console);
  if (!store) return store.error();
  const auto version = store->revert(arguments.version, now_text());
  if (!version) return console.fail(version.error());
  return report_change(arguments, console, *version, "back");
}

}  // namespace recald::daemon
