#include "adapters/series/remote_write.hpp"

#include <snappy.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>

namespace recald::series {
namespace {

using Labels = std::vector<std::pair<std::string, std::string>>;
using Samples = std::map<std::int64_t, double>;  // by milliseconds since 1970

// Protocol buffers: https://protobuf.dev/programming-guides/encoding. A tag is 8 · field + kind.
constexpr char kVarint = 0;
constexpr char kFixed64 = 1;
constexpr char kBytes = 2;
constexpr char tag(int field, char kind) { return static_cast<char>(8 * field + kind); }

void add_varint(std::string& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7U) out += static_cast<char>((value & 0x7FU) | 0x80U);
  out += static_cast<char>(value);
}

void add_bytes(std::string& out, int field, std::string_view bytes) {
  out += tag(field, kBytes);
  add_varint(out, bytes.size());
  out += bytes;
}

void add_double(std::string& out, int field, double value) {
  out += tag(field, kFixed64);
  const auto bits = std::bit_cast<std::uint64_t>(value);
  for (unsigned shift = 0; shift < 64; shift += 8) out += static_cast<char>(bits >> shift);
}

// Label.name = 1, Label.value = 2.
std::string label_message(const std::pair<std::string, std::string>& label) {
  std::string out;
  add_bytes(out, 1, label.first);
  add_bytes(out, 2, label.second);
  return out;
}

// Sample.value = 1, Sample.timestamp = 2, in milliseconds.
std::string sample_message(std::int64_t time_ms, double value) {
  std::string out;
  add_double(out, 1, value);
  out += tag(2, kVarint);
  add_varint(out, static_cast<std::uint64_t>(time_ms));
  return out;
}

// TimeSeries.labels = 1, TimeSeries.samples = 2.
std::string series_message(const Labels& labels, const Samples& samples) {
  std::string out;
  for (const auto& label : labels) add_bytes(out, 1, label_message(label));
  for (const auto& [time_ms, value] : samples) add_bytes(out, 2, sample_message(time_ms, value));
  return out;
}

Labels labels_of(const Point& point, const Field& field) {
  Labels labels{{"__name__", point.measurement + '_' + field.name}};
  for (const auto& label : point.labels) {
    if (!label.second.empty()) labels.push_back(label);
  }
  std::ranges::sort(labels);
  return labels;
}

}  // namespace

std::string remote_write_body(std::span<const Point> points) {
  std::map<Labels, Samples> series;
  for (const Point& point : points) {
    const std::int64_t time_ms = std::chrono::milliseconds{point.time.time_since_epoch()}.count();
    for (const Field& field : point.fields) {
      if (std::isfinite(field.value)) series[labels_of(point, field)][time_ms] = field.value;
    }
  }
  std::string request;  // WriteRequest.timeseries = 1
  for (const auto& [labels, samples] : series) {
    add_bytes(request, 1, series_message(labels, samples));
  }
  std::string body;
  snappy::Compress(request.data(), request.size(), &body);
  return body;
}

}  // namespace recald::series
