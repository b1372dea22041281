// Writes a sample report to the file named on the command line, for the browser test.
#include <fstream>
#include <iostream>
#include <map>
#include <string>

#include "adapters/views/calibration/report.hpp"
#include "adapters/views/diagnosis/diagnosis_page.hpp"
#include "adapters/views/drift/drift_page.hpp"
#include "adapters/views/meters/meters_page.hpp"
#include "adapters/views/savings/savings_page.hpp"
#include "tests/adapters/views/sample_diagnosis.hpp"
#include "tests/adapters/views/sample_drift.hpp"
#include "tests/adapters/views/sample_meters.hpp"
#include "tests/adapters/views/sample_report.hpp"
#include "tests/adapters/views/sample_savings.hpp"

namespace {

using Page = std::string (*)();

const std::map<std::string, Page>& pages() {
  using namespace recald::views;
  static const std::map<std::string, Page> kPages = {
      {"full", [] { return render_report(sample_report()); }},
      {"readings-only", [] { return render_report(readings_only_report()); }},
      {"design", [] { return render_report(design_report()); }},
      {"diagnosis", [] { return render_diagnosis(sample_diagnosis()); }},
      {"unconfirmed", [] { return render_diagnosis(unconfirmed_diagnosis()); }},
      {"meters", [] { return render_meters(sample_meters()); }},
      {"young-meters", [] { return render_meters(young_meters()); }},
      {"drift", [] { return render_drift(sample_drift()); }},
      {"savings", [] { return render_savings(sample_savings()); }},
      {"saved", [] { return render_savings(realised_savings()); }},
      {"empty-handed", [] { return render_diagnosis(empty_handed_diagnosis()); }},
  };
  return kPages;
}

}  // namespace

int main(int argc, char** argv) {
  const auto page = pages().find(argc == 3 ? argv[1] : "");
  if (page == pages().end()) {
    std::cerr << "usage: write_sample_report PAGE FILE.html, PAGE one of:";
    for (const auto& [name, write] : pages()) std::cerr << ' ' << name;
    std::cerr << '\n';
    return 2;
  }
  std::ofstream file(argv[2], std::ios::binary);
  file << page->second();
  file.close();
  if (!file) {
    std::cerr << argv[2] << " cannot be written\n";
    return 1;
  }
  return 0;
}
