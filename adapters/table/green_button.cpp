#include "adapters/table/green_button.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include "adapters/csv/fields.hpp"
#include "adapters/csv/reading_intake.hpp"
#include "adapters/table/element_cutter.hpp"
#include "adapters/table/xml_nodes.hpp"

namespace recald::table {
namespace {

using metering::Instant;
using metering::Utility;
using std::chrono::seconds;

constexpr std::size_t kEntryMax = 32u << 20;  // bytes of one entry of the feed
constexpr std::size_t kReadingsMax = 4'000'000;
constexpr std::size_t kMetersMax = 1000;

std::string_view text_of(const pugi::xml_node& node, std::string_view name) {
  return csv::trimmed(child_named(node, name).text().get());
}

/// The part of a link from the resource on; hosts and customers differ between links of a feed.
std::string resource(std::string_view link, std::string_view from, std::string_view until) {
  const std::size_t begin = link.rfind(from);
  if (begin == std::string_view::npos) return {};
  link.remove_prefix(begin);
  const std::size_t end = until.empty() ? std::string_view::npos : link.find(until);
  link = link.substr(0, end);
  while (!link.empty() && link.back() == '/') link.remove_suffix(1);
  return std::string{link};
}

/// "UsagePoint/1/MeterReading/2" from the link to a meter reading or to one of its blocks.
std::string meter_reading(std::string_view link) {
  if (link.find("MeterReading") == std::string_view::npos) return {};
  std::string key = resource(link, "UsagePoint/", "/IntervalBlock");
  return key.empty() ? resource(link, "MeterReading/", "/IntervalBlock") : key;
}

/// Units of measure by code (IEC 61968-9), as far as they concern energy.
std::string unit_of(std::int64_t code) {
  struct Unit {
    std::int64_t code;
    std::string_view name;
  };
  constexpr std::array kUnits{
      Unit{31, "J"},
      Unit{38, "W"},
      Unit{42, "m3"},
      Unit{72, "Wh"},
      Unit{119, "ft3"},
      Unit{120, "ft3"},
      Unit{122, "cf/h"},
      Unit{123, "ft3"},
      Unit{125, "m3/h"},
      Unit{132, "BTU"},
      Unit{133, "BTU/h"},
      Unit{166, "m3"},
      Unit{167, "m3"},
      Unit{169, "therm"},
      // No energy, named so that people know what was left out.
      Unit{5, "A"},
      Unit{23, "degC"},
      Unit{29, "V"},
      Unit{33, "Hz"},
      Unit{61, "VA"},
      Unit{63, "var"},
      Unit{65, "cos phi"},
      Unit{71, "VAh"},
      Unit{73, "varh"},
  };
  for (const Unit& unit : kUnits) {
    if (unit.code == code) return std::string{unit.name};
  }
  return "uom " + std::to_string(code);
}

std::optional<Utility> utility_of(std::string_view service_kind) {
  const auto kind = whole_number(service_kind);
  if (!kind) return {};
  switch (*kind) {
    case 0:
      return Utility::electricity;
    case 1:
      return Utility::gas;
    case 2:
      return Utility::water;
    case 4:
      return Utility::heating;
    default:
      return {};
  }
}

struct ReadingType {
  std::string unit;
  int power_of_ten = 0;
  bool is_register = false;
  bool is_reverse = false;
  std::optional<seconds> interval;
  int tariff = 0;
};

ReadingType reading_type(const pugi::xml_node& node) {
  ReadingType type;
  type.unit = unit_of(whole_number(text_of(node, "uom")).value_or(72));
  const auto power = whole_number(text_of(node, "powerOfTenMultiplier")).value_or(0);
  type.power_of_ten = static_cast<int>(std::clamp<std::int64_t>(power, -12, 12));
  const auto behaviour = whole_number(text_of(node, "accumulationBehaviour")).value_or(4);
  type.is_register = behaviour == 1 || behaviour == 2 || behaviour == 3;  // bulk and cumulative
  type.is_reverse = whole_number(text_of(node, "flowDirection")).value_or(1) == 19;
  const auto length = whole_number(text_of(node, "intervalLength")).value_or(0);
  if (length > 0 && length <= 86'400) type.interval = seconds{length};
  const auto tariff = whole_number(text_of(node, "tou")).value_or(0);
  if (tariff > 0 && tariff < 100) type.tariff = static_cast<int>(tariff);
  return type;
}

/// Collects a feed. The description of a meter may come after its readings.
class FeedBuilder {
 public:
  Result<void> add_entry(const pugi::xml_node& entry) {
    const Links links = links_of(entry);
    for (const pugi::xml_node& content : entry.children()) {
      if (local_name(content.name()) != "content") continue;
      for (const pugi::xml_node& node : content.children()) {
        if (auto added = add_resource(node, links, text_of(entry, "title")); !added) return added;
      }
    }
    return {};
  }

  Result<Feed> finish() {
    Feed feed;
    std::vector<double> scales;
    for (const auto& [key, number] : in_order()) {
      FeedMeter meter{.name = key};
      const auto described = meters_.find(key);
      if (described != meters_.end()) meter.title = described->second.title;
      const ReadingType type = type_of(described == meters_.end() ? "" : described->second.type);
      meter.unit = type.unit;
      meter.is_register = type.is_register;
      meter.is_reverse = type.is_reverse;
      meter.interval = type.interval;
      meter.tariff = type.tariff;
      const auto service = services_.find(key.substr(0, key.find("/MeterReading")));
      if (service != services_.end()) meter.utility = service->second;
      scales.push_back(std::pow(10.0, type.power_of_ten));
      feed.meters.push_back(std::move(meter));
    }
    for (FeedReading& reading : readings_) reading.value *= scales[reading.meter];
    std::stable_sort(readings_.begin(), readings_.end(), [](const auto& a, const auto& b) {
      return a.start != b.start ? a.start < b.start : a.meter < b.meter;
    });
    feed.readings = std::move(readings_);
    return feed;
  }

 private:
  struct Links {
    std::string self;
    std::string up;
    std::vector<std::string> related;
  };
  struct Described {
    std::string title;
    std::string type;  ///< Key of its reading type.
  };

  static Links links_of(const pugi::xml_node& entry) {
    Links links;
    for (const pugi::xml_node& link : entry.children()) {
      if (local_name(link.name()) != "link") continue;
      const std::string_view rel = link.attribute("rel").value();
      const std::string_view href = link.attribute("href").value();
      if (rel == "self") links.self = href;
      if (rel == "up") links.up = href;
      if (rel == "related") links.related.emplace_back(href);
    }
    return links;
  }

  Result<void> add_resource(const pugi::xml_node& node, const Links& links,
                            std::string_view title) {
    const std::string_view kind = local_name(node.name());
    if (kind == "ReadingType") {
      types_[resource(links.self, "ReadingType/", "")] = reading_type(node);
    } else if (kind == "UsagePoint") {
      const auto service = utility_of(text_of(child_named(node, "ServiceCategory"), "kind"));
      services_[resource(links.self, "UsagePoint/", "")] = service;
    } else if (kind == "MeterReading") {
      last_meter_ = meter_reading(links.self);
      Described described{.title = std::string{title}, .type = {}};
      for (const std::string& related : links.related) {
        const std::string type = resource(related, "ReadingType/", "");
        if (!type.empty()) described.type = type;
      }
      meters_[last_meter_] = std::move(described);
    } else if (kind == "IntervalBlock") {
      return add_block(node, links);
    }
    return {};
  }

  Result<void> add_block(const pugi::xml_node& block, const Links& links) {
    std::string key = meter_reading(links.up);
    if (key.empty()) key = meter_reading(links.self);
    if (key.empty()) key = last_meter_.empty() ? "MeterReading" : last_meter_;
    const auto number = numbers_.try_emplace(key, static_cast<std::uint32_t>(numbers_.size()));
    if (numbers_.size() > kMetersMax) {
      return failure(ErrorCode::malformed, "the feed has more than a thousand meters");
    }
    for (const pugi::xml_node& reading : block.children()) {
      if (local_name(reading.name()) != "IntervalReading") continue;
      if (auto added = add_reading(reading, number.first->second); !added) return added;
    }
    return {};
  }

  Result<void> add_reading(const pugi::xml_node& node, std::uint32_t meter) {
    if (readings_.size() == kReadingsMax) {
      return failure(ErrorCode::malformed,
                     "the feed has more than four million readings; export fewer years at once");
    }
    const std::string_view start = text_of(child_named(node, "timePeriod"), "start");
    const auto since = whole_number(start);
    if (!since || *since < 366 * 86'400 ||
        *since >= metering::kLatestInstant.time_since_epoch().count() - 86'400) {
      return failure(ErrorCode::malformed, "an interval starts at " + csv::in_quotes(start) +
                                               ", which is no second of " +
                                               std::string{metering::kKnownYears});
    }
    const std::string_view text = text_of(node, "value");
    const auto value = csv::parse_number(text);
    if (!value && !text.empty()) {
      return failure(ErrorCode::malformed,
                     "the reading at " + metering::to_string(Instant{seconds{*since}}) + " is " +
                         csv::in_quotes(text) + ", which is no number");
    }
    if (value && std::abs(*value) > csv::kValueMax) {
      return failure(ErrorCode::malformed,
                     "the reading at " + metering::to_string(Instant{seconds{*since}}) + " is " +
                         csv::in_quotes(text) + ", more than any meter counts");
    }
    const auto quality = whole_number(text_of(child_named(node, "ReadingQuality"), "quality"));
    readings_.push_back(
        {Instant{seconds{*since}}, meter,
         static_cast<std::uint8_t>(std::clamp<std::int64_t>(quality.value_or(0), 0, 255)),
         value.value_or(std::numeric_limits<double>::quiet_NaN())});
    return {};
  }

  /// If the feed describes only one type, it applies to all meters.
  [[nodiscard]] ReadingType type_of(const std::string& key) const {
    const auto found = types_.find(key);
    if (found != types_.end()) return found->second;
    return types_.size() == 1 ? types_.begin()->second : ReadingType{.unit = "Wh"};
  }

  [[nodiscard]] std::vector<std::pair<std::string, std::uint32_t>> in_order() const {
    std::vector<std::pair<std::string, std::uint32_t>> all{numbers_.begin(), numbers_.end()};
    std::sort(all.begin(), all.end(),
              [](const auto& a, const auto& b) { return a.second < b.second; });
    return all;
  }

  std::map<std::string, ReadingType> types_;
  std::map<std::string, std::optional<Utility>> services_;
  std::map<std::string, Described> meters_;
  std::map<std::string, std::uint32_t> numbers_;  ///< Only meters with readings.
  std::string last_meter_;
  std::vector<FeedReading> readings_;
};

class FeedRows final : public RowSource {
 public:
  explicit FeedRows(Feed feed) : feed_{std::move(feed)} {}

  bool next(TableRow& row) override {
    row = {};
    row.number = number_ + 1;
    if (number_ == 0) {
      row.cells = {"timestamp", "meter", "value", "unit", "quality"};
    } else if (number_ > feed_.readings.size()) {
      return false;
    } else {
      const FeedReading& reading = feed_.readings[number_ - 1];
      const FeedMeter& meter = feed_.meters[reading.meter];
      stamp_ = metering::to_string(reading.start);
      value_.clear();
      if (!std::isnan(reading.value)) {
        std::array<char, 64> text{};
        const auto end = std::to_chars(text.data(), text.data() + text.size(), reading.value).ptr;
        value_.assign(text.data(), end);
      }
      quality_ = std::to_string(reading.quality);
      row.cells = {stamp_, meter.name, value_, meter.unit, quality_};
      text_ = stamp_ + ", " + meter.name + ", " + value_ + ", " + meter.unit;
      row.text = text_;
    }
    ++number_;
    return true;
  }

  [[nodiscard]] const std::optional<Error>& error() const override { return error_; }

 private:
  Feed feed_;
  std::uint64_t number_ = 0;  ///< Rows returned so far.
  std::string stamp_;
  std::string value_;
  std::string quality_;
  std::string text_;
  std::optional<Error> error_;
};

}  // namespace

Result<Feed> parse_green_button(csv::ByteSource bytes) {
  ElementCutter cutter{std::move(bytes), {"entry"}, kEntryMax};
  FeedBuilder builder;
  pugi::xml_document document;
  for (std::string_view entry; cutter.next(entry);) {
    if (!document.load_buffer(entry.data(), entry.size())) {
      return failure(ErrorCode::malformed, "an entry of the feed is no XML");
    }
    TRY(builder.add_entry(document.document_element()));
  }
  if (cutter.error()) return tl::unexpected(*cutter.error());
  auto feed = builder.finish();
  if (feed && feed->readings.empty()) {
    return failure(ErrorCode::malformed,
                   "no interval readings; is it a Green Button feed (ESPI XML)?");
  }
  return feed;
}

Result<Feed> read_green_button(const std::filesystem::path& file) {
  auto bytes = TRY(csv::open_file(file, "Green Button file"));
  auto feed = parse_green_button(std::move(bytes));
  if (feed) return feed;
  return failure(feed.error().code,
                 "Green Button file '" + file.string() + "': " + feed.error().message);
}

std::unique_ptr<RowSource> feed_rows(Feed feed) {
  return std::make_unique<FeedRows>(std::move(feed));
}

Result<std::unique_ptr<RowSource>> open_green_button(const std::filesystem::path& file) {
  auto feed = TRY(read_green_button(file));
  return feed_rows(std::move(feed));
}

}  // namespace recald::table
