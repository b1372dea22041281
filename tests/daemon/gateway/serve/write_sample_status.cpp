// Writes a page of the daemon of a site that has troubles to a file, for the browser test.
//
//   write_sample_status now|meter|months|model|data|events FILE.html
#include <fstream>
#include <iostream>
#include <map>
#include <string>

#include "tests/daemon/gateway/serve/served_site.hpp"

namespace recald::daemon {
namespace {

struct TroubledSite final : ServedSite {
  TroubledSite() {
    site_.file = std::filesystem::temp_directory_path() / "no such site.toml";
    site_.model.emplace();
    devices_.erase(2);
    begin();
    loop_.run_for(std::chrono::hours{24 * 40});
    const bool is_written =
        disk_
            .commit({.events = {{kStart, Severity::warning, "counter_reset", "main",
                                 "The counter of main began anew; its energy is counted on."}}})
            .has_value() &&
        disk_
            .add_job({.state = JobState::failed,
                      .asked_by = "api",
                      .asked = kStart,
                      .message = "The site has no model."})
            .has_value() &&
        disk_.add_forecasts(forecasts()).has_value();
    if (!is_written) std::abort();
  }

  void TestBody() override {}

  /// A year, of which two months are not as expected.
  static std::vector<StoredForecast> forecasts() {
    std::vector<StoredForecast> all;
    for (unsigned month = 1; month <= 12; ++month) {
      const double mean = 1400.0 + 30.0 * (month > 6 ? 13.0 - month : month);
      all.push_back({.output = "main_daily_kWh",
                     .month = std::chrono::year{2023} / static_cast<int>(month),
                     .made = kStart,
                     .mean = mean,
                     .sd = 30.0,
                     .q05 = mean - 50.0,
                     .q50 = mean,
                     .q95 = mean + 50.0,
                     .measured = mean + (month > 10 ? 120.0 : 10.0),
                     .pit = 0.5,
                     .standardised = 0.0,
                     .log_score = -5.0,
                     .crps = 10.0});
    }
    return all;
  }

  /// With its style sheet and the charts' script inside: a browser lets no file read another.
  std::string page(const std::string& path) {
    std::string text = get(path).body;
    const auto replace = [&text](const std::string& from, const std::string& to) {
      if (const std::size_t at = text.find(from); at != std::string::npos) {
        text.replace(at, from.size(), to);
      }
    };
    replace("<script src=\"/page.js\" defer></script>", "");
    replace("<script src=\"/charts.js\" defer></script>",
            "<script>" + get("/charts.js").body + "</script>");
    replace("<link rel=\"stylesheet\" href=\"/style.css\">",
            "<style>" + get("/style.css").body + "</style>");
    return text;
  }
};

}  // namespace
}  // namespace recald::daemon

int main(int argc, char** argv) {
  const std::map<std::string, std::string> paths{{"now", "/"},          {"meter", "/meters/main"},
                                                 {"months", "/months"}, {"model", "/model"},
                                                 {"data", "/data"},     {"events", "/events"}};
  const auto path = argc == 3 ? paths.find(argv[1]) : paths.end();
  if (path == paths.end()) {
    std::cerr << "usage: write_sample_status now|meter|months|model|data|events FILE.html\n";
    return 2;
  }
  recald::daemon::TroubledSite site;
  std::ofstream page{argv[2], std::ios::binary};
  page << site.page(path->second);
  page.close();
  return page ? 0 : 1;
}
