// Writes the status page of a site that has troubles to a file, for the browser test.
//
//   write_sample_status FILE.html
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

  /// With its style sheet inside: a browser lets no file read another.
  std::string page() {
    std::string text = get("/").body;
    const std::string link = "<link rel=\"stylesheet\" href=\"/style.css\">";
    return text.replace(text.find(link), link.size(),
                        "<style>" + get("/style.css").body + "</style>");
  }
};

}  // namespace
}  // namespace recald::daemon

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: write_sample_status FILE.html\n";
    return 2;
  }
  recald::daemon::TroubledSite site;
  std::ofstream page{argv[1], std::ios::binary};
  page << site.page();
  page.close();
  return page ? 0 : 1;
}
