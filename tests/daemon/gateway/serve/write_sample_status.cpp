// Writes the status page of a site that has troubles, with its style sheet, for the browser test.
//
//   write_sample_status FOLDER
#include <filesystem>
#include <fstream>
#include <iostream>

#include "tests/daemon/gateway/serve/served_site.hpp"

namespace recald::daemon {
namespace {

struct TroubledSite final : ServedSite {
  TroubledSite() {
    devices_.erase(2);
    begin();
    loop_.run_for(std::chrono::hours{2} + std::chrono::seconds{30});
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
            .has_value();
    if (!is_written) std::abort();
  }

  void TestBody() override {}

  /// As a file that finds its style sheet beside itself.
  std::string page() {
    std::string text = get("/").body;
    const std::string link = "href=\"/style.css\"";
    return text.replace(text.find(link), link.size(), "href=\"style.css\"");
  }

  std::string style() { return get("/style.css").body; }
};

}  // namespace
}  // namespace recald::daemon

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: write_sample_status FOLDER\n";
    return 2;
  }
  recald::daemon::TroubledSite site;
  const std::filesystem::path folder{argv[1]};
  std::ofstream page{folder / "status.html", std::ios::binary};
  std::ofstream style{folder / "style.css", std::ios::binary};
  page << site.page();
  style << site.style();
  page.close();
  style.close();
  return page && style ? 0 : 1;
}
