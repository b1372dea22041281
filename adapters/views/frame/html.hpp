/// Builds pieces of HTML. Everything that is not a literal in our own source goes through `escape`.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace recald::views {

/// Escapes text for element content and quoted attribute values.
[[nodiscard]] std::string escape(std::string_view text);

/// A page under construction.
class Html {
 public:
  /// Appends markup unchanged. @pre written by us; never a name or sentence from outside.
  Html& markup(std::string_view trusted);

  /// Appends text, escaped.
  Html& text(std::string_view untrusted);

  /// <tag class="css_class">text</tag>, with the text escaped. No class attribute if it is empty.
  Html& element(std::string_view tag, std::string_view text, std::string_view css_class = "");

  /// <a href="address">text</a>, both escaped. @pre the address has our own scheme and path.
  Html& link(std::string_view address, std::string_view untrusted);

  [[nodiscard]] const std::string& str() const { return out_; }

 private:
  std::string out_;
};

/// One cell of a table.
struct Cell {
  std::string text;
  std::string_view css_class = "";  ///< One of ours: "number", "good", "bad", "muted".
  std::string address = {};         ///< Of a link on the text; empty: none.
};

/// A table with a caption, a head and rows whose first cell names the row.
class Table {
 public:
  explicit Table(std::string caption) : caption_(std::move(caption)) {}

  /// Adds a row above the column names, in which each label spans a number of columns.
  Table& column_groups(std::vector<std::pair<std::string, int>> groups);
  Table& columns(std::vector<std::string> names);
  /// Adds a heading inside the body that spans the table.
  Table& group(std::string label);
  Table& row(std::vector<Cell> cells);
  /// Gives each cell its column's name, so that a narrow window can show rows as lists.
  Table& with_labels();

  /// Writes the caption, then the table inside a box that scrolls sideways if the
  /// window is too narrow.
  void write(Html& html) const;

 private:
  struct Row {
    std::vector<Cell> cells;
    bool is_group;
  };

  void write_head(Html& html) const;
  void write_body(Html& html) const;
  [[nodiscard]] std::string attributes_of(const Row& row, std::size_t column) const;
  /// Headings of numbers are right-aligned, like the numbers.
  [[nodiscard]] bool holds_numbers(std::size_t column) const;

  std::string caption_;
  std::vector<std::pair<std::string, int>> column_groups_;
  std::vector<std::string> columns_;
  std::vector<Row> rows_;
  bool is_labelled_ = false;
};

/// The place where the script draws a figure, with the text around it.
struct Figure {
  std::string_view kind;  ///< Type of drawing: "months", "cvrmse", "parameter", "peaks", …
  int index = 0;          ///< Index within its type, in the order of the report's data.
  std::string title;
  std::string description;     ///< What the figure shows, for readers who cannot see it.
  std::string caption;         ///< How to read it.
  std::string_view size = "";  ///< "", "small", "tall", "map", "overview" or "small pair".
};

/// The figure, followed by its data as a table, which also works without JavaScript.
void write_figure(Html& html, const Figure& figure, const Table& data);

/// Opens a <section> with an id and a heading; the caller closes it with "</section>".
void open_section(Html& html, std::string_view id, std::string_view heading);

}  // namespace recald::views
