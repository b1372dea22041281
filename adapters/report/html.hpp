/// Small pieces of HTML. Whatever is not a literal in our own source goes through `escape`.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace recald::report {

/// Text made safe for element content and for quoted attribute values.
[[nodiscard]] std::string escape(std::string_view text);

/// A page under construction.
class Html {
 public:
  /// Appends markup as it is. @pre written by us; never a name or sentence from outside.
  Html& markup(std::string_view trusted);

  /// Appends text, escaped.
  Html& text(std::string_view untrusted);

  /// <tag class="css_class">text</tag>, the text escaped. No class attribute where it is empty.
  Html& element(std::string_view tag, std::string_view text, std::string_view css_class = "");

  [[nodiscard]] const std::string& str() const { return out_; }

 private:
  std::string out_;
};

/// One cell of a table.
struct Cell {
  std::string text;
  std::string_view css_class = "";  ///< One of ours: "number", "good", "bad", "muted".
};

/// A table with a caption, a head and rows whose first cell names the row.
class Table {
 public:
  explicit Table(std::string caption) : caption_(std::move(caption)) {}

  /// A line above the column names: each label spans so many columns.
  Table& column_groups(std::vector<std::pair<std::string, int>> groups);
  Table& columns(std::vector<std::string> names);
  /// A heading inside the body that spans the table.
  Table& group(std::string label);
  Table& row(std::vector<Cell> cells);
  /// Each cell carries its column's name, so that a narrow window can show rows as lists.
  Table& with_labels();

  /// Writes the caption, then the table inside a box that scrolls sideways where the window is too
  /// narrow.
  void write(Html& html) const;

 private:
  struct Row {
    std::vector<Cell> cells;
    bool is_group;
  };

  void write_head(Html& html) const;
  void write_body(Html& html) const;
  [[nodiscard]] std::string attributes_of(const Row& row, std::size_t column) const;
  /// Heads stand above their numbers, on the right.
  [[nodiscard]] bool holds_numbers(std::size_t column) const;

  std::string caption_;
  std::vector<std::pair<std::string, int>> column_groups_;
  std::vector<std::string> columns_;
  std::vector<Row> rows_;
  bool is_labelled_ = false;
};

/// Where the script draws a figure, and what stands around it.
struct Figure {
  std::string_view kind;  ///< Which drawing: "months", "cvrmse", "parameter", "peaks", …
  int index = 0;          ///< Which of the kind, in the order of the report's data.
  std::string title;
  std::string description;     ///< What the figure shows, for those who do not see it.
  std::string caption;         ///< How to read it.
  std::string_view size = "";  ///< "", "small", "tall", "map", "overview" or "small pair".
};

/// The figure with its data as a table below it; the table is there without JavaScript too.
void write_figure(Html& html, const Figure& figure, const Table& data);

/// Opens a <section> with an id and a heading; the caller closes it with "</section>".
void open_section(Html& html, std::string_view id, std::string_view heading);

}  // namespace recald::report
