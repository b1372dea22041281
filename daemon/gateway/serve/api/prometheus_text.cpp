#include "daemon/gateway/serve/api/prometheus_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace recald::daemon {
namespace {

/// Label values and help texts must be one line.
std::string escaped(std::string_view text, bool with_quotes) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\\\";
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '"' && with_quotes) {
      out += "\\\"";
    } else {
      out += c;
    }
  }
  return out;
}

/// Independent of the locale: fmt writes a dot.
std::string number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
  return fmt::format("{}", value);
}

}  // namespace

void PrometheusText::begin(std::string_view name, std::string_view type, std::string_view help) {
  name_ = name;
  out_ += fmt::format("# HELP {} {}\n# TYPE {} {}\n", name, escaped(help, false), name, type);
}

void PrometheusText::line(std::string_view suffix, Labels labels, std::string_view le,
                          double value) {
  out_ += name_;
  out_ += suffix;
  char separator = '{';
  const auto label = [&](std::string_view name, std::string_view text) {
    fmt::format_to(std::back_inserter(out_), "{}{}=\"{}\"", separator, name, escaped(text, true));
    separator = ',';
  };
  for (const auto& [name, text] : labels) label(name, text);
  if (!le.empty()) label("le", le);
  if (separator == ',') out_ += '}';
  out_ += ' ';
  out_ += number(value);
  out_ += '\n';
}

void PrometheusText::sample(double value, Labels labels) { line("", labels, "", value); }

void PrometheusText::histogram(const LatencyHistogram& histogram, Labels labels) {
  for (std::size_t i = 0; i < LatencyHistogram::kBounds_s.size(); ++i) {
    line("_bucket", labels, number(LatencyHistogram::kBounds_s[i]),
         static_cast<double>(histogram.at_most()[i]));
  }
  const auto count = static_cast<double>(histogram.count());
  line("_bucket", labels, "+Inf", count);
  line("_sum", labels, "", histogram.sum_s());
  line("_count", labels, "", count);
}

}  // namespace recald::daemon
