/// Prometheus' text format read as strictly as its own tools check it.
#pragma once

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace recald::testing {

struct MetricFamily {
  std::string type;
  std::string help;
  std::map<std::string, double> samples;  ///< By what stands before the value, as it was written.
};

struct Exposition {
  std::map<std::string, MetricFamily> families;
  std::vector<std::string> problems;

  /// The sample written so, or nothing.
  [[nodiscard]] std::optional<double> sample(const std::string& series) const {
    for (const auto& [name, family] : families) {
      if (const auto found = family.samples.find(series); found != family.samples.end()) {
        return found->second;
      }
    }
    return {};
  }
  /// Series whose labels contain a text.
  [[nodiscard]] int count_with(const std::string& label) const {
    int count = 0;
    for (const auto& [name, family] : families) {
      for (const auto& [series, value] : family.samples) {
        count += series.find(label) != std::string::npos;
      }
    }
    return count;
  }
};

inline double prometheus_number(const std::string& text) {
  if (text == "+Inf") return std::numeric_limits<double>::infinity();
  std::size_t end = 0;
  const double value = std::stod(text, &end);
  if (end != text.size()) throw std::invalid_argument(text);
  return value;
}

/// A histogram's buckets rise, end in +Inf, and that is its count; by label set.
inline void check_histogram(const std::string& name, const MetricFamily& family,
                            std::vector<std::string>& problems) {
  std::map<std::string, std::map<double, double>> buckets;
  std::map<std::string, double> counts;
  std::set<std::string> sums;
  static const std::regex bucket{R"re(\w+_bucket\{(?:(.*),)?le="([^"]*)"\})re"};
  static const std::regex total{R"(\w+_(sum|count)(?:\{(.*)\})?)"};
  for (const auto& [series, value] : family.samples) {
    std::smatch match;
    if (std::regex_match(series, match, bucket)) {
      buckets[match[1]][prometheus_number(match[2])] = value;
    } else if (std::regex_match(series, match, total)) {
      if (match[1] == "sum") {
        sums.insert(match[2]);
      } else {
        counts[match[2]] = value;
      }
    } else {
      problems.push_back(name + ": not a histogram's sample: " + series);
    }
  }
  if (buckets.size() != counts.size() || sums.size() != counts.size()) {
    problems.push_back(name + ": buckets, sums and counts are not the same sets");
  }
  for (const auto& [labels, by_bound] : buckets) {
    double last = 0.0;
    for (const auto& [bound, value] : by_bound) {
      if (value < last) problems.push_back(name + ": buckets fall");
      last = value;
    }
    if (!std::isinf(by_bound.rbegin()->first)) problems.push_back(name + ": no +Inf bucket");
    if (last != counts[labels]) problems.push_back(name + ": +Inf bucket is not the count");
  }
}

inline Exposition parse_prometheus(const std::string& text) {
  Exposition exposition;
  const auto wrong = [&](const std::string& what) { exposition.problems.push_back(what); };
  if (!text.ends_with('\n')) wrong("the last line does not end");
  static const std::regex help{R"(# HELP ([a-z_][a-z0-9_]*) (\S.*))"};
  static const std::regex type{R"(# TYPE ([a-z_][a-z0-9_]*) (counter|gauge|histogram))"};
  static const std::regex sample{
      R"re((([a-z_][a-z0-9_]*)(\{([a-z_]+="([^"\\]|\\[\\"n])*")(,[a-z_]+="([^"\\]|\\[\\"n])*")*\})?) (\S+))re"};
  std::istringstream lines{text};
  std::string line;
  std::string current;
  while (std::getline(lines, line)) {
    std::smatch match;
    if (std::regex_match(line, match, help)) {
      current = match[1];
      if (exposition.families.contains(current)) wrong(current + ": begun twice");
      exposition.families[current].help = match[2];
    } else if (std::regex_match(line, match, type)) {
      if (match[1] != current) wrong("TYPE without its HELP: " + line);
      MetricFamily& family = exposition.families[match[1]];
      if (!family.samples.empty() || !family.type.empty()) wrong("TYPE too late: " + line);
      family.type = match[2];
    } else if (std::regex_match(line, match, sample)) {
      const std::string name = match[2];
      MetricFamily& family = exposition.families[current];
      const bool is_part =
          family.type == "histogram" &&
          (name == current + "_bucket" || name == current + "_sum" || name == current + "_count");
      if (name != current && !is_part) wrong("sample outside its family: " + line);
      if (!family.samples.emplace(match[1], prometheus_number(match[8])).second) {
        wrong("series given twice: " + line);
      }
    } else {
      wrong("no line of the format: " + line);
    }
  }
  for (const auto& [name, family] : exposition.families) {
    if (family.type.empty()) wrong(name + ": no TYPE");
    if ((family.type == "counter") != name.ends_with("_total")) {
      wrong(name + ": counters, and they alone, end in _total");
    }
    if (family.type == "histogram") check_histogram(name, family, exposition.problems);
  }
  return exposition;
}

}  // namespace recald::testing
