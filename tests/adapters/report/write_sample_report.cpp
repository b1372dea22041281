// Writes a sample report to the file named on the command line, for the browser test.
#include <fstream>
#include <iostream>
#include <string>

#include "adapters/report/report.hpp"
#include "tests/adapters/report/sample_report.hpp"

int main(int argc, char** argv) {
  const std::string which = argc == 3 ? argv[1] : "";
  if (which != "full" && which != "readings-only") {
    std::cerr << "usage: write_sample_report full|readings-only FILE.html\n";
    return 2;
  }
  std::ofstream file(argv[2], std::ios::binary);
  file << recald::report::render_report(which == "full" ? recald::report::sample_report()
                                                        : recald::report::readings_only_report());
  file.close();
  if (!file) {
    std::cerr << argv[2] << " cannot be written\n";
    return 1;
  }
  return 0;
}
