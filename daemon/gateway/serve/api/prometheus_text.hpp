/// Prometheus' text format, version 0.0.4.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/gateway/poll/latency_histogram.hpp"

namespace recald::daemon {

/// Labels of one sample, in this order.
using Labels = std::initializer_list<std::pair<std::string_view, std::string_view>>;

/// Writes families one after the other: begin each one once, then add its samples.
class PrometheusText {
 public:
  void begin(std::string_view name, std::string_view type, std::string_view help);

  /// Adds a sample to the current family. NaN and infinity are written as Prometheus reads them.
  void sample(double value, Labels labels = {});

  /// Adds buckets, sum and count. @pre the family's type is "histogram"
  void histogram(const LatencyHistogram& histogram, Labels labels = {});

  [[nodiscard]] const std::string& str() const { return out_; }

 private:
  void line(std::string_view suffix, Labels labels, std::string_view le, double value);

  std::string name_;
  std::string out_;
};

}  // namespace recald::daemon
