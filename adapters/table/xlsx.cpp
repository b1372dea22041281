#include "adapters/table/xlsx.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "adapters/csv/fields.hpp"
#include "adapters/table/archive.hpp"
#include "adapters/table/element_cutter.hpp"
#include "adapters/table/xml_nodes.hpp"
#include "core/text/ascii.hpp"

namespace recald::table {
namespace {

using std::chrono::seconds;

constexpr std::size_t kPartMax = 16u << 20;  // largest part that is read as a whole, in bytes
constexpr std::size_t kSheetsMax = 1000;
constexpr std::size_t kRowMax = 4u << 20;         // of one row
constexpr std::size_t kSharedMax = 64u << 20;     // of all shared texts
constexpr std::size_t kSheetColumnsMax = 16'384;  // as the format has it

bool is_named(const pugi::xml_node& node, std::string_view name) {
  return local_name(node.name()) == name;
}

/// Appends all text below a node, except phonetic guides.
void add_text(const pugi::xml_node& node, std::string& text) {
  // Without recursion: a file chooses how deep it goes.
  pugi::xml_node one = node.first_child();
  while (one) {
    const bool is_text = is_named(one, "t");
    if (is_text) text += one.text().get();
    if (!is_text && !is_named(one, "rPh") && one.first_child()) {
      one = one.first_child();
      continue;
    }
    while (one != node && !one.next_sibling()) one = one.parent();
    one = one == node ? pugi::xml_node{} : one.next_sibling();
  }
}

Result<std::string> whole_part(const Archive& archive, const std::string& entry) {
  const auto bytes = TRY(archive.bytes_of(entry));
  std::string part;
  for (;;) {
    const std::size_t had = part.size();
    part.resize(had + 64 * 1024);
    const auto got = TRY(bytes(part.data() + had, part.size() - had));
    part.resize(had + got);
    if (got == 0) return part;
    if (part.size() > kPartMax) {
      return failure(ErrorCode::malformed, "'" + entry + "' of the workbook is too large");
    }
  }
}

Result<void> parse_part(const Archive& archive, const std::string& entry,
                        pugi::xml_document& document) {
  const auto part = TRY(whole_part(archive, entry));
  if (!document.load_buffer(part.data(), part.size())) {
    return failure(ErrorCode::malformed, "'" + entry + "' of the workbook is no XML");
  }
  return {};
}

struct Sheet {
  std::string name;
  std::string entry;
  bool is_hidden = false;
};

struct Workbook {
  std::vector<Sheet> sheets;
  bool counts_from_1904 = false;
};

/// The path of a part that is given relative to xl/.
std::string entry_of(std::string_view target) {
  return target.starts_with('/') ? std::string{target.substr(1)} : "xl/" + std::string{target};
}

Result<Workbook> read_workbook(const Archive& archive) {
  pugi::xml_document document;
  pugi::xml_document relations;
  TRY(parse_part(archive, "xl/workbook.xml", document));
  TRY(parse_part(archive, "xl/_rels/workbook.xml.rels", relations));
  Workbook book;
  const pugi::xml_node root = document.document_element();
  const std::string_view epoch = attribute(child_named(root, "workbookPr"), "date1904");
  book.counts_from_1904 = epoch == "1" || epoch == "true";
  std::map<std::string_view, std::string> entries;
  for (const pugi::xml_node& relation : relations.document_element().children()) {
    entries.emplace(relation.attribute("Id").value(),
                    entry_of(relation.attribute("Target").value()));
  }
  for (const pugi::xml_node& sheet : child_named(root, "sheets").children()) {
    const std::string_view id = attribute(sheet, "id");
    const auto entry = id.empty() ? entries.end() : entries.find(id);
    if (entry == entries.end()) continue;
    if (book.sheets.size() == kSheetsMax) {
      return failure(ErrorCode::malformed, "the workbook has more than 1000 sheets");
    }
    const std::string_view state = attribute(sheet, "state");
    book.sheets.push_back({std::string{attribute(sheet, "name")}, entry->second,
                           state == "hidden" || state == "veryHidden"});
  }
  return book;
}

enum class Kind : std::uint8_t { number, date, date_and_time, time };

/// What a number format shows of a day count.
Kind kind_of_code(std::string_view code) {
  bool has_date = false;
  bool has_time = false;
  bool in_quotes = false;
  for (std::size_t i = 0; i < code.size(); ++i) {
    const char c = to_lower(code[i]);
    if (c == '"') in_quotes = !in_quotes;
    if (in_quotes) continue;
    if (c == '\\' || c == '_' || c == '*') ++i;  // the next letter is shown literally
    if (c == '[') {
      const std::size_t end = std::min(code.find(']', i), code.size());
      const std::string_view inside = code.substr(i + 1, end - i - 1);
      if (inside == "h" || inside == "hh" || inside == "m" || inside == "mm") return Kind::number;
      i = end;
    }
    if (c == ';') break;  // the format of positive numbers is enough
    has_date = has_date || c == 'y' || c == 'd';
    has_time = has_time || c == 'h' || c == 's';
    // Behind a date or a time digits are parts of a second, as in ss.000.
    const bool is_digit = c == 'e' || c == '#' || c == '0';
    if (is_digit && !has_date && !has_time) return Kind::number;
  }
  if (has_date) return has_time ? Kind::date_and_time : Kind::date;
  return has_time ? Kind::time : Kind::number;
}

Kind kind_of_id(int id) {
  if ((id >= 14 && id <= 17) || (id >= 27 && id <= 31) || (id >= 50 && id <= 58)) return Kind::date;
  if ((id >= 18 && id <= 21) || (id >= 32 && id <= 36) || id == 45 || id == 47) return Kind::time;
  return id == 22 ? Kind::date_and_time : Kind::number;
}

/// The kind of cell for each style.
Result<std::vector<Kind>> read_styles(const Archive& archive) {
  std::vector<Kind> kinds;
  if (!archive.has("xl/styles.xml")) return kinds;
  pugi::xml_document document;
  TRY(parse_part(archive, "xl/styles.xml", document));
  const pugi::xml_node root = document.document_element();
  std::map<int, Kind> formats;
  for (const pugi::xml_node& format : child_named(root, "numFmts").children()) {
    const auto id = whole_number(attribute(format, "numFmtId"));
    if (id) formats[static_cast<int>(*id)] = kind_of_code(attribute(format, "formatCode"));
  }
  for (const pugi::xml_node& style : child_named(root, "cellXfs").children()) {
    const int id = static_cast<int>(whole_number(attribute(style, "numFmtId")).value_or(0));
    const auto format = formats.find(id);
    kinds.push_back(format == formats.end() ? kind_of_id(id) : format->second);
  }
  return kinds;
}

Result<std::vector<std::string>> read_shared(const Archive& archive) {
  std::vector<std::string> texts;
  if (!archive.has("xl/sharedStrings.xml")) return texts;
  auto bytes = TRY(archive.bytes_of("xl/sharedStrings.xml"));
  ElementCutter cutter{std::move(bytes), {"si"}, kRowMax};
  std::size_t size = 0;
  for (std::string_view element; cutter.next(element);) {
    pugi::xml_document document;
    std::string text;
    if (document.load_buffer(element.data(), element.size())) {
      add_text(document.document_element(), text);
    }
    size += text.size() + sizeof text;
    if (size > kSharedMax) {
      return failure(ErrorCode::malformed, "the workbook has more than 64 MiB of texts");
    }
    texts.push_back(std::move(text));
  }
  if (cutter.error()) return tl::unexpected(*cutter.error());
  return texts;
}

std::string time_text(std::int64_t second_of_day) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%02d:%02d:%02d", static_cast<int>(second_of_day / 3600),
                static_cast<int>(second_of_day / 60 % 60), static_cast<int>(second_of_day % 60));
  return text.data();
}

/// A day count as the date and time it stands for.
std::string date_text(double serial_days, Kind kind) {
  constexpr std::int64_t kEpoch_days = 25'569;  // of 1970-01-01
  const std::int64_t since =
      std::llround((serial_days - static_cast<double>(kEpoch_days)) * 86'400.0);
  const metering::Instant t{seconds{since}};
  const auto midnight = std::chrono::floor<std::chrono::days>(t);
  const std::string day = metering::to_string(metering::Day{midnight});
  if (kind == Kind::date && t == midnight) return day;
  return day + " " + time_text((t - midnight).count());
}

/// The column index: 0 for "A7", 27 for "AB1".
std::optional<std::size_t> column_of(std::string_view reference) {
  std::size_t column = 0;
  std::size_t letters = 0;
  for (; letters < reference.size() && reference[letters] >= 'A' && reference[letters] <= 'Z';
       ++letters) {
    column = 26 * column + static_cast<std::size_t>(reference[letters] - 'A') + 1;
    if (column > kSheetColumnsMax) return {};
  }
  if (letters == 0) return {};
  return column - 1;
}

class SheetRows final : public RowSource {
 public:
  SheetRows(csv::ByteSource bytes, bool counts_from_1904, std::vector<Kind> styles,
            std::vector<std::string> shared)
      : cutter_{std::move(bytes), {"row"}, kRowMax},
        styles_{std::move(styles)},
        shared_{std::move(shared)},
        day_shift_{counts_from_1904 ? 1462.0 : 0.0} {}

  bool next(TableRow& row) override {
    std::string_view element;
    if (!cutter_.next(element)) return false;
    row.problem = {};
    row.is_terminated = true;
    row.cells.clear();
    texts_.clear();
    if (!document_.load_buffer(element.data(), element.size())) {
      row.number = ++number_;
      row.problem = "the row is no XML";
      return true;
    }
    const pugi::xml_node node = document_.document_element();
    const auto given = whole_number(attribute(node, "r"));
    number_ = given && *given > 0 ? static_cast<std::uint64_t>(*given) : number_ + 1;
    row.number = number_;
    for (const pugi::xml_node& cell : node.children()) add_cell(cell);
    joined_.clear();
    for (const std::string& text : texts_) {
      if (!joined_.empty()) joined_ += ", ";
      joined_ += text;
      row.cells.push_back(csv::trimmed(text));
    }
    row.text = joined_;
    return true;
  }

  [[nodiscard]] const std::optional<Error>& error() const override { return cutter_.error(); }

 private:
  void add_cell(const pugi::xml_node& cell) {
    if (!is_named(cell, "c")) return;
    const std::string_view reference = attribute(cell, "r");
    const auto column = reference.empty() ? std::optional{texts_.size()} : column_of(reference);
    if (!column || *column >= kSheetColumnsMax || *column < texts_.size()) return;
    texts_.resize(*column);  // omitted cells are blank
    texts_.push_back(text_of(cell));
  }

  [[nodiscard]] std::string text_of(const pugi::xml_node& cell) const {
    const std::string_view type = attribute(cell, "t");
    std::string text;
    if (type == "inlineStr") {
      add_text(child_named(cell, "is"), text);
      return text;
    }
    text = child_named(cell, "v").text().get();
    if (type == "s") {
      const auto index = static_cast<std::size_t>(whole_number(text).value_or(-1));
      return index < shared_.size() ? shared_[index] : "";
    }
    if (type == "e") return "";  // #DIV/0!, #N/A: nothing was measured
    const auto style = static_cast<std::size_t>(whole_number(attribute(cell, "s")).value_or(0));
    if ((type.empty() || type == "n") && style < styles_.size()) {
      return dated(text, styles_[style]);
    }
    return text;
  }

  [[nodiscard]] std::string dated(const std::string& text, Kind kind) const {
    const auto serial = csv::parse_number(text);
    if (kind == Kind::number || !serial) return text;
    if (*serial >= 0.0 && *serial < 1.0) return time_text(std::llround(*serial * 86'400.0));
    if (*serial < 0.0 || *serial > 80'000.0) return text;
    return date_text(*serial + day_shift_, kind);
  }

  ElementCutter cutter_;
  std::vector<Kind> styles_;
  std::vector<std::string> shared_;
  double day_shift_;
  pugi::xml_document document_;
  std::uint64_t number_ = 0;
  std::vector<std::string> texts_;
  std::string joined_;
};

tl::unexpected<Error> in_file(const std::filesystem::path& file, const Error& error) {
  const std::string name = file.string();
  if (error.message.find(name) != std::string::npos) return tl::unexpected(error);
  return tl::unexpected(Error{error.code, "workbook '" + name + "': " + error.message});
}

}  // namespace

Result<std::vector<std::string>> sheet_names(const std::filesystem::path& file) {
  const auto archive = TRY(Archive::open(file));
  const auto book = read_workbook(archive);
  if (!book) return in_file(file, book.error());
  std::vector<std::string> names;
  for (const Sheet& sheet : book->sheets) {
    if (!sheet.is_hidden) names.push_back(sheet.name);
  }
  if (!names.empty()) return names;
  for (const Sheet& sheet : book->sheets) names.push_back(sheet.name);
  return names;
}

Result<std::unique_ptr<RowSource>> open_sheet(const std::filesystem::path& file,
                                              const std::string& sheet) {
  const auto archive = TRY(Archive::open(file));
  const auto book = read_workbook(archive);
  if (!book) return in_file(file, book.error());
  auto found = std::find_if(book->sheets.begin(), book->sheets.end(), [&](const Sheet& one) {
    return sheet.empty() ? !one.is_hidden : one.name == sheet;
  });
  if (sheet.empty() && found == book->sheets.end()) found = book->sheets.begin();
  if (found == book->sheets.end()) {
    std::string names;
    for (const Sheet& one : book->sheets) names += (names.empty() ? "" : ", ") + one.name;
    return failure(ErrorCode::malformed,
                   "workbook '" + file.string() + "' has no sheet " + csv::in_quotes(sheet) +
                       (names.empty() ? "; it has none" : "; it has " + names));
  }
  auto styles = read_styles(archive);
  if (!styles) return in_file(file, styles.error());
  auto shared = read_shared(archive);
  if (!shared) return in_file(file, shared.error());
  auto bytes = archive.bytes_of(found->entry);
  if (!bytes) return in_file(file, bytes.error());
  return std::make_unique<SheetRows>(std::move(*bytes), book->counts_from_1904, std::move(*styles),
                                     std::move(*shared));
}

}  // namespace recald::table
