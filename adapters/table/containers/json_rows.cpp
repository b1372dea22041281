#include "adapters/table/containers/json_rows.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace recald::table {
namespace {

constexpr std::size_t kBytesMax = 512u << 20;
constexpr std::size_t kDepthMax = 64;
constexpr std::size_t kPathMax = 300;  // bytes of a place in the document
constexpr std::size_t kPathsMax = 2000;
constexpr std::size_t kTextMax = 400;  // bytes of a text; a longer one is no cell
constexpr std::size_t kListedMax = 4'000'000;
constexpr std::size_t kFewest = 2;  // readings of a list

/// The bytes of a text, one by one.
class Characters {
 public:
  explicit Characters(csv::ByteSource bytes) : bytes_{std::move(bytes)} {}

  [[nodiscard]] bool is_end() {
    if (at_ < size_) return false;
    if (is_done_) return true;
    const auto got = bytes_(buffer_.data(), buffer_.size());
    if (!got) error_ = got.error();
    size_ = got ? *got : 0;
    at_ = 0;
    total_ += size_;
    if (total_ > kBytesMax) {
      error_.emplace(ErrorCode::malformed, "it is longer than 512 MiB; export fewer days at once");
    }
    is_done_ = size_ == 0 || error_.has_value();
    return is_done_;
  }
  [[nodiscard]] char front() const { return buffer_[at_]; }
  void pop() { ++at_; }
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  csv::ByteSource bytes_;
  std::array<char, 64 * 1024> buffer_{};
  std::size_t at_ = 0;
  std::size_t size_ = 0;
  std::size_t total_ = 0;
  bool is_done_ = false;
  std::optional<Error> error_;
};

/// Goes through the characters once; the default one is the end.
class CharacterIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = char;

  CharacterIterator() = default;
  explicit CharacterIterator(Characters& from) : from_{&from} {}
  char operator*() const { return from_->front(); }
  CharacterIterator& operator++() {
    from_->pop();
    return *this;
  }
  CharacterIterator operator++(int) {
    const CharacterIterator before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const CharacterIterator& a, const CharacterIterator& b) {
    return a.is_at_end() == b.is_at_end();
  }
  friend bool operator!=(const CharacterIterator& a, const CharacterIterator& b) {
    return !(a == b);
  }

 private:
  [[nodiscard]] bool is_at_end() const { return from_ == nullptr || from_->is_end(); }
  Characters* from_ = nullptr;
};

/// Follows a document and keeps the place: keys joined by dots, "[]" for the members of a list.
/// `records()` is the part of a place up to its last list.
class PlaceTracker : public nlohmann::json_sax<nlohmann::json> {
 public:
  bool null() override { return take(""); }
  bool boolean(bool value) override { return take(value ? "true" : "false"); }
  bool number_integer(number_integer_t value) override { return take(std::to_string(value)); }
  bool number_unsigned(number_unsigned_t value) override { return take(std::to_string(value)); }
  bool number_float(number_float_t, const string_t& text) override { return take(text); }
  bool string(string_t& text) override { return take(text.size() > kTextMax ? "" : text); }
  bool binary(binary_t&) override { return take(""); }

  bool start_object(std::size_t) override { return enter(false); }
  bool start_array(std::size_t) override { return enter(true); }
  bool end_object() override { return leave(); }
  bool end_array() override { return leave(); }
  bool key(string_t& key) override {
    place_.resize(frames_.back().length);
    if (!place_.empty()) place_ += '.';
    place_ += key.substr(0, kTextMax);
    return place_.size() <= kPathMax || stop("a key of it is too long");
  }
  bool parse_error(std::size_t at, const std::string&,
                   const nlohmann::detail::exception&) override {
    return stop("it is no JSON from byte " + std::to_string(at) + " on");
  }

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }
  void start_document() {
    place_.clear();
    frames_.clear();
  }

 protected:
  /// A container begins, or ended, at `place()`. @param is_list  And which kind it is.
  virtual bool on_enter(bool is_list) = 0;
  virtual void on_leave(bool is_list) = 0;
  virtual bool on_scalar(std::string_view text) = 0;

  [[nodiscard]] const std::string& place() const { return place_; }
  [[nodiscard]] bool is_in_list() const { return !frames_.empty() && frames_.back().is_list; }
  /// Members of the innermost list before this one.
  [[nodiscard]] std::size_t index() const { return frames_.back().members - 1; }
  [[nodiscard]] std::string_view records() const {
    const std::size_t at = place_.rfind("[]");
    return at == std::string::npos ? std::string_view{}
                                   : std::string_view{place_}.substr(0, at + 2);
  }
  bool stop(std::string_view why) {
    if (!error_) error_.emplace(ErrorCode::malformed, why);
    return false;
  }

 private:
  struct Frame {
    bool is_list;
    std::size_t length;  ///< Of the place of the container.
    std::size_t members = 0;
  };

  void begin_member() {
    if (!is_in_list()) return;
    place_.resize(frames_.back().length);
    place_ += "[]";
    ++frames_.back().members;
  }

  bool enter(bool is_list) {
    begin_member();
    if (frames_.size() == kDepthMax) return stop("it is nested more than 64 deep");
    if (place_.size() > kPathMax) return stop("its keys are too long");
    if (!on_enter(is_list)) return false;
    frames_.push_back({is_list, place_.size()});
    return true;
  }

  bool leave() {
    place_.resize(frames_.back().length);
    const bool is_list = frames_.back().is_list;
    frames_.pop_back();
    on_leave(is_list);
    return true;
  }

  bool take(std::string_view text) {
    begin_member();
    return on_scalar(text);
  }

  std::string place_;
  std::vector<Frame> frames_;
  std::optional<Error> error_;
};

Result<void> follow(csv::ByteSource bytes, PlaceTracker& tracker) {
  Characters characters{std::move(bytes)};
  constexpr std::string_view kBetween = " \t\r\n,\x1e\xEF\xBB\xBF";  // also a byte order mark
  for (;;) {
    while (!characters.is_end() && kBetween.find(characters.front()) != std::string_view::npos) {
      characters.pop();
    }
    if (characters.error()) return tl::unexpected(*characters.error());
    if (characters.is_end()) return {};
    tracker.start_document();
    const bool is_read =
        nlohmann::json::sax_parse(CharacterIterator{characters}, CharacterIterator{}, &tracker,
                                  nlohmann::json::input_format_t::json, /*strict=*/false);
    if (characters.error()) return tl::unexpected(*characters.error());
    if (!is_read) {
      return tl::unexpected(tracker.error().value_or(Error{ErrorCode::malformed, "it is no JSON"}));
    }
  }
}

/// Which part of a document has the readings.
struct ListPlace {
  std::string place;         ///< Of each reading; of the object that has the lists.
  bool is_of_lists = false;  ///< Lists of equal length beside each other.
};

/// Counts what stands where.
class ListFinder final : public PlaceTracker {
 public:
  [[nodiscard]] Result<ListPlace> best() const {
    const auto longest = std::ranges::max_element(
        places_, {}, [](const auto& one) { return one.second.readings(); });
    const std::size_t most = longest == places_.end() ? 0 : longest->second.readings();
    std::size_t rows = 0;
    const std::string* parent = nullptr;
    for (const auto& [place, lists] : lists_) {
      const std::size_t count = lists.rows();
      if (count <= rows) continue;
      rows = count;
      parent = &place;
    }
    if (parent != nullptr && rows > most) return ListPlace{*parent, true};
    if (most < kFewest) {
      return failure(ErrorCode::malformed,
                     "it has no list of readings: objects with a time and a value each, or lists "
                     "of times and of values");
    }
    return ListPlace{longest->first, false};
  }

 private:
  struct Counts {
    std::size_t containers = 0;
    std::size_t scalars = 0;
    /// A reading has a time and a value at least.
    [[nodiscard]] std::size_t readings() const {
      return scalars >= 2 * containers ? containers : 0;
    }
  };
  /// Lists of scalars in the objects at one place.
  struct Lists {
    std::map<std::string, std::size_t> lengths;
    /// The length that at least two of them have.
    [[nodiscard]] std::size_t rows() const {
      std::map<std::size_t, int> same;
      for (const auto& [name, length] : lengths) ++same[length];
      std::size_t longest = 0;
      for (const auto& [length, count] : same) {
        if (count > 1) longest = std::max(longest, length);
      }
      return longest;
    }
  };

  bool on_enter(bool) override {
    const bool is_member = place().ends_with("[]") || place().empty();
    if (!is_member) return true;
    if (places_.size() >= kPathsMax) return stop("it has more than 2000 different kinds of lists");
    ++places_[place()].containers;
    return true;
  }
  void on_leave(bool) override {}

  bool on_scalar(std::string_view) override {
    if (!is_in_list()) {
      ++places_[std::string{records()}].scalars;
      return true;
    }
    const std::string_view list = std::string_view{place()}.substr(0, place().size() - 2);
    if (list.ends_with("[]")) {
      ++places_[std::string{list}].scalars;
      return true;
    }
    const std::size_t dot = list.rfind('.');
    const std::string parent{dot == std::string_view::npos ? "" : list.substr(0, dot)};
    if (lists_.size() >= kPathsMax) return stop("it has more than 2000 different kinds of lists");
    Lists& lists = lists_[parent];
    if (lists.lengths.size() < kCellsMax) ++lists.lengths[std::string{list}];
    return true;
  }

  std::map<std::string, Counts> places_;
  std::map<std::string, Lists> lists_;
};

/// Readings with their columns, in little memory.
struct ListedReadings {
  struct Cell {
    std::uint32_t column;
    std::uint32_t begin;
    std::uint32_t length;
  };
  struct Reading {
    std::uint32_t first_cell;
    std::uint32_t cells;
    std::uint32_t around;  ///< In `surroundings`.
  };
  std::string bytes;
  std::vector<Cell> cells;
  std::vector<Reading> readings;
  std::vector<std::vector<Cell>> surroundings;  ///< What stands around readings, outermost first.
  std::vector<std::uint32_t> parents;           ///< Of each of these.
  std::vector<std::string> columns;
};

constexpr std::uint32_t kNoParent = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kNoColumn = kNoParent;

/// Collects the readings at one place.
class ListReader final : public PlaceTracker {
 public:
  explicit ListReader(ListPlace place) : where_{std::move(place)} {}

  [[nodiscard]] ListedReadings take() {
    arrange_columns();
    return std::move(listed_);
  }

 private:
  /// Whether the place is an object or a list around the readings.
  [[nodiscard]] bool is_around(std::string_view at) const {
    const std::string& inner = where_.place;
    if (at.size() > inner.size() || inner.compare(0, at.size(), at) != 0) return false;
    if (at.size() == inner.size()) return where_.is_of_lists;
    return at.empty() || at.ends_with("[]");
  }
  [[nodiscard]] bool is_reading(std::string_view at) const {
    return !where_.is_of_lists && at == where_.place;
  }

  bool on_enter(bool) override {
    if (is_reading(place())) {
      if (listed_.readings.size() == kListedMax) {
        return stop("it has more than four million readings; export fewer days at once");
      }
      listed_.readings.push_back({static_cast<std::uint32_t>(listed_.cells.size()), 0, around_});
      is_inside_ = true;
    } else if ((place().empty() || place().ends_with("[]") || place() == where_.place) &&
               is_around(place())) {
      listed_.surroundings.emplace_back();
      listed_.parents.push_back(around_);
      around_ = static_cast<std::uint32_t>(listed_.surroundings.size() - 1);
      open_.push_back(place());
    }
    return true;
  }

  void on_leave(bool) override {
    if (is_inside_ && is_reading(place())) {
      is_inside_ = false;
      listed_.readings.back().cells =
          static_cast<std::uint32_t>(listed_.cells.size()) - listed_.readings.back().first_cell;
      return;
    }
    if (open_.empty() || open_.back() != place()) return;
    if (where_.is_of_lists && place() == where_.place) zip_lists();
    open_.pop_back();
    around_ = listed_.parents[around_];
  }

  bool on_scalar(std::string_view text) override {
    if (is_inside_) return add_to_reading(text);
    if (where_.is_of_lists && is_in_list()) return add_to_list(text);
    if (is_in_list() || around_ == kNoParent) return true;
    // Of another list beside the readings nothing is told.
    if (records() != std::string_view{open_.back()}.substr(0, records().size()) ||
        open_.back().find("[]", records().size()) != std::string::npos) {
      return true;
    }
    return add(text, place(), listed_.surroundings[around_]);
  }

  bool add_to_reading(std::string_view text) {
    const std::size_t outer = where_.place.size();
    std::string_view name = std::string_view{place()}.substr(std::min(outer, place().size()));
    if (name.starts_with('.')) name.remove_prefix(1);
    if (is_in_list()) {
      if (name != "[]") return true;  // a list within a reading
      return add(text, "item " + std::to_string(index() + 1), listed_.cells);
    }
    if (name.find("[]") != std::string_view::npos) return true;
    return add(text, name, listed_.cells);
  }

  bool add_to_list(std::string_view text) {
    const std::string list = place().substr(0, place().size() - 2);
    const std::size_t dot = list.rfind('.');
    const std::string_view parent =
        dot == std::string::npos ? std::string_view{} : std::string_view{list}.substr(0, dot);
    if (parent != where_.place) return true;
    auto& texts = lists_[list.substr(dot == std::string::npos ? 0 : dot + 1)];
    if (texts.size() == kListedMax || lists_.size() > kCellsMax) {
      return stop("it has more than four million readings; export fewer days at once");
    }
    texts.emplace_back(text);
    return true;
  }

  /// Lists that are as long as another one are columns.
  void zip_lists() {
    std::map<std::size_t, int> same;
    for (const auto& [name, texts] : lists_) ++same[texts.size()];
    std::size_t rows = 0;
    for (const auto& [length, count] : same) {
      if (count > 1) rows = length;
    }
    for (std::size_t i = 0; i < rows && listed_.readings.size() < kListedMax; ++i) {
      listed_.readings.push_back({static_cast<std::uint32_t>(listed_.cells.size()), 0, around_});
      for (const auto& [name, texts] : lists_) {
        if (texts.size() == rows) (void)add(texts[i], name, listed_.cells);
      }
      listed_.readings.back().cells =
          static_cast<std::uint32_t>(listed_.cells.size()) - listed_.readings.back().first_cell;
    }
    lists_.clear();
  }

  bool add(std::string_view text, std::string_view name, std::vector<ListedReadings::Cell>& to) {
    auto known = columns_.find(name);
    if (known == columns_.end()) {
      if (columns_.size() == kCellsMax) return stop("its readings have more than 1024 keys");
      known =
          columns_.emplace(std::string{name}, static_cast<std::uint32_t>(columns_.size())).first;
      std::string shown{name};
      for (std::size_t at; (at = shown.find("[]")) != std::string::npos;) shown.erase(at, 2);
      listed_.columns.push_back(std::move(shown));
    }
    to.push_back({known->second, static_cast<std::uint32_t>(listed_.bytes.size()),
                  static_cast<std::uint32_t>(text.size())});
    listed_.bytes += text;
    return true;
  }

  /// Columns of the readings come first. Of what stands around them, a number or a date that is the
  /// same everywhere says nothing of a reading: a count of pages, a latitude, a period.
  void arrange_columns() {
    std::vector<bool> is_own(listed_.columns.size());
    for (const ListedReadings::Cell& cell : listed_.cells) is_own[cell.column] = true;
    std::vector<std::set<std::string_view>> texts(listed_.columns.size());
    const std::string_view bytes = listed_.bytes;
    for (const auto& around : listed_.surroundings) {
      for (const auto& cell : around) {
        if (texts[cell.column].size() > 1) continue;
        texts[cell.column].insert(bytes.substr(cell.begin, cell.length));
      }
    }
    std::vector<std::uint32_t> places(listed_.columns.size(), kNoColumn);
    std::vector<std::string> columns;
    for (const bool wants_own : {true, false}) {
      for (std::size_t i = 0; i < places.size(); ++i) {
        const bool is_idle = !is_own[i] && texts[i].size() == 1 && !has_letter(*texts[i].begin());
        if (is_own[i] != wants_own || is_idle) continue;
        places[i] = static_cast<std::uint32_t>(columns.size());
        columns.push_back(std::move(listed_.columns[i]));
      }
    }
    listed_.columns = std::move(columns);
    for (ListedReadings::Cell& cell : listed_.cells) cell.column = places[cell.column];
    for (auto& around : listed_.surroundings) {
      for (ListedReadings::Cell& cell : around) cell.column = places[cell.column];
      std::erase_if(around, [](const auto& cell) { return cell.column == kNoColumn; });
    }
  }

  static bool has_letter(std::string_view text) {
    return std::ranges::any_of(
        text, [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; });
  }

  ListPlace where_;
  ListedReadings listed_;
  std::map<std::string, std::uint32_t, std::less<>> columns_;
  std::uint32_t around_ = kNoParent;
  std::vector<std::string> open_;  ///< Places of the containers around, outermost first.
  bool is_inside_ = false;
  std::map<std::string, std::vector<std::string>> lists_;
};

class JsonRows final : public RowSource {
 public:
  explicit JsonRows(ListedReadings listed) : listed_{std::move(listed)} {}

  bool next(TableRow& row) override {
    row.problem = {};
    row.is_terminated = true;
    row.number = at_ + 1;
    row.cells.assign(listed_.columns.size(), {});
    if (at_ == 0) {
      row.cells.assign(listed_.columns.begin(), listed_.columns.end());
    } else if (at_ > listed_.readings.size()) {
      return false;
    } else {
      fill(listed_.readings[at_ - 1], row);
    }
    ++at_;
    joined_.clear();
    for (const std::string_view cell : row.cells) {
      if (!joined_.empty()) joined_ += ", ";
      joined_ += cell;
    }
    row.text = joined_;
    return true;
  }

  [[nodiscard]] const std::optional<Error>& error() const override { return none_; }

 private:
  void fill(const ListedReadings::Reading& reading, TableRow& row) const {
    const std::string_view bytes = listed_.bytes;
    const auto set = [&](const ListedReadings::Cell& cell) {
      row.cells[cell.column] = bytes.substr(cell.begin, cell.length);
    };
    for (std::uint32_t around = reading.around; around != kNoParent;
         around = listed_.parents[around]) {
      std::ranges::for_each(listed_.surroundings[around], set);
    }
    for (std::uint32_t i = 0; i < reading.cells; ++i) set(listed_.cells[reading.first_cell + i]);
  }

  ListedReadings listed_;
  std::size_t at_ = 0;
  std::string joined_;
  std::optional<Error> none_;
};

}  // namespace

Result<std::unique_ptr<RowSource>> json_rows(const std::function<Result<csv::ByteSource>()>& open) {
  ListFinder finder;
  auto first = TRY(open());
  TRY(follow(std::move(first), finder));
  auto place = TRY(finder.best());
  ListReader reader{std::move(place)};
  auto second = TRY(open());
  TRY(follow(std::move(second), reader));
  return std::make_unique<JsonRows>(reader.take());
}

}  // namespace recald::table
