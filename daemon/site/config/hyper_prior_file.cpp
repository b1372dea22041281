#include "daemon/site/config/hyper_prior_file.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "adapters/system/files/read_file.hpp"
#include "adapters/system/files/regular_file.hpp"
#include "core/text/nearest.hpp"
#include "core/text/printable.hpp"

namespace recald::daemon {
namespace {

using calibration::BetaPrior;
using calibration::GammaPrior;
using calibration::HyperPrior;

GammaPrior read_gamma(TomlReader& root, std::string_view key) {
  auto table = root.table(key);
  if (!table) {
    if (!root.has(key)) root.problem(fmt::format("[{}] with shape and rate is missing", key));
    return {1.0, 1.0};
  }
  const GammaPrior prior{table->required_number("shape", kPositive),
                         table->required_number("rate", kPositive)};
  table->finish();
  return prior;
}

BetaPrior read_rho(TomlReader& root) {
  BetaPrior prior{1.0, 0.3};  // as in all profiles
  if (auto table = root.table("rho")) {
    prior.a = table->required_number("a", kPositive);
    prior.b = table->required_number("b", kPositive);
    table->finish();
  }
  return prior;
}

}  // namespace

tl::expected<HyperPrior, Problems> load_hyper_prior(const std::filesystem::path& file) {
  Problems problems;
  if (const auto is_file = system::require_file(file, "hyper-prior file"); !is_file) {
    return tl::unexpected(Problems{is_file.error().message});
  }
  const auto text = system::read_file(file);
  if (!text) return tl::unexpected(Problems{text.error().message});
  try {
    const toml::table table = parse_toml(*text, file.string());
    TomlReader root{table, file.filename().string(), "", problems};
    const GammaPrior discrepancy = read_gamma(root, "discrepancy");
    const GammaPrior error = read_gamma(root, "error");
    const BetaPrior rho = read_rho(root);
    root.finish();
    if (!problems.empty()) return tl::unexpected(problems);
    const auto made = calibration::make_custom_hyper_prior(discrepancy, error, rho);
    if (made) return *made;
    root.problem(made.error().message);
  } catch (const toml::parse_error& error) {
    problems.push_back(syntax_problem(file.filename().string(), error));
  }
  return tl::unexpected(problems);
}

tl::expected<std::variant<calibration::HyperPriorProfile, HyperPrior>, Problems> choose_hyper_prior(
    const std::string& text) {
  using Choice = std::variant<calibration::HyperPriorProfile, HyperPrior>;
  if (text.ends_with(".toml")) {
    return load_hyper_prior(text).map([](HyperPrior prior) { return Choice{std::move(prior)}; });
  }
  const auto profile = calibration::parse_hyper_prior_profile(text);
  if (profile) return Choice{*profile};
  constexpr std::array<std::string_view, 5> kProfiles{"scaled", "seed", "stan2018", "wide",
                                                      "tight"};
  if (const std::string_view nearest = nearest_name(text, kProfiles); !nearest.empty()) {
    return tl::unexpected(Problems{fmt::format(
        "'{}' is not a hyper-prior profile; did you mean '{}'?", printable(text), nearest)});
  }
  return tl::unexpected(Problems{profile.error().message + ", or name a file that ends in .toml"});
}

}  // namespace recald::daemon
