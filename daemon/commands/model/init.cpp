#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "adapters/system/files/write_file.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/model/export_draft.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

int run_init(const InitArguments& arguments, const Console& console) {
  const std::filesystem::path folder = arguments.out.empty() ? "." : arguments.out;
  const std::filesystem::path file =
      arguments.out.empty() ? std::filesystem::path{"site.toml"} : folder / "site.toml";
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {
    return console.fail(
        fmt::format("'{}' is there already; name another folder with --out, or "
                    "move it away",
                    file.string()));
  }
  const Console asking{console.out, console.err, console.is_terminal, console.detail,
                       arguments.asks_nothing || arguments.json ? nullptr : console.answers};
  const auto prepared =
      draft_aloud(arguments.files, arguments.timezone, arguments.hints, folder, asking);
  if (!prepared) return prepared.error();
  const auto& [exports, timezone, calendar, draft, hints] = *prepared;
  // Nothing is written that would not load.
  const auto drafted = parse_site(draft.text, file);
  if (!drafted) return console.fail(drafted.error());
  const auto text =
      with_starter(draft.text, *drafted, exports, calendar, arguments.starter, folder);
  if (!text) return console.fail(text.error());
  if (const auto site = parse_site(*text, file); !site) return console.fail(site.error());
  if (auto made = system::make_folder(folder); !made) return console.fail(made.error());
  if (auto written = system::write_file(file, *text); !written) {
    return console.fail(written.error());
  }
  const std::string next = fmt::format("recald report {} --out {}", shell_word(file),
                                       shell_word(file.parent_path() / "page.html"));
  if (arguments.json) {
    const nlohmann::ordered_json json{{"site", file.string()},
                                      {"meters", meters_json(*prepared)},
                                      {"guesses", draft.guesses},
                                      {"next", next}};
    console.out << json.dump(2) << "\n";
    return kSuccess;
  }
  const double area_m2 = arguments.starter.floor_area_m2;
  print_draft(*prepared, "Look at these; the file says more beside its keys:",
              area_m2 > 0.0 ? std::optional{area_m2} : std::nullopt, console);
  console.out << fmt::format("Wrote {} with {} meter{}. Next:\n  {}\n", file.string(),
                             draft.meter_ids.size(), draft.meter_ids.size() == 1 ? "" : "s", next);
  return kSuccess;
}

}  // namespace recald::daemon
