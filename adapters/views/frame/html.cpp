#include "adapters/views/frame/html.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace recald::views {

std::string escape(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      case '\0':
        safe += "\xEF\xBF\xBD";
        break;  // U+FFFD, as a browser would show it
      default:
        safe += c;
    }
  }
  return safe;
}

Html& Html::markup(std::string_view trusted) {
  out_ += trusted;
  return *this;
}

Html& Html::text(std::string_view untrusted) {
  out_ += escape(untrusted);
  return *this;
}

Html& Html::link(std::string_view address, std::string_view untrusted) {
  return markup("<a href=\"" + escape(address) + "\">").text(untrusted).markup("</a>");
}

Html& Html::element(std::string_view tag, std::string_view text, std::string_view css_class) {
  const std::string attribute =
      css_class.empty() ? "" : fmt::format(" class=\"{}\"", escape(css_class));
  out_ += fmt::format("<{0}{1}>{2}</{0}>\n", tag, attribute, escape(text));
  return *this;
}

Table& Table::column_groups(std::vector<std::pair<std::string, int>> groups) {
  column_groups_ = std::move(groups);
  return *this;
}

Table& Table::columns(std::vector<std::string> names) {
  columns_ = std::move(names);
  return *this;
}

Table& Table::group(std::string label) {
  rows_.push_back({{{std::move(label)}}, true});
  return *this;
}

Table& Table::row(std::vector<Cell> cells) {
  rows_.push_back({std::move(cells), false});
  return *this;
}

Table& Table::with_labels() {
  is_labelled_ = true;
  return *this;
}

void Table::write(Html& html) const {
  html.element("p", caption_, "caption")
      .markup("<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"")
      .text(caption_)
      .markup(is_labelled_ ? "\"><table class=\"labelled\">\n" : "\"><table>\n");
  write_head(html);
  write_body(html);
  html.markup("</table></div>\n");
}

void Table::write_head(Html& html) const {
  html.markup("<thead>\n");
  if (!column_groups_.empty()) {
    html.markup("<tr>");
    for (const auto& [label, span] : column_groups_) {
      const bool empty = label.empty();
      html.markup(fmt::format("<{} colspan=\"{}\">", empty ? "td" : "th scope=\"colgroup\"", span))
          .text(label)
          .markup(empty ? "</td>" : "</th>");
    }
    html.markup("</tr>\n");
  }
  html.markup("<tr>");
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].empty()) {
      html.markup("<td></td>");
      continue;
    }
    html.markup(holds_numbers(i) ? "<th scope=\"col\" class=\"number\">" : "<th scope=\"col\">")
        .text(columns_[i])
        .markup("</th>");
  }
  html.markup("</tr>\n</thead>\n");
}

bool Table::holds_numbers(std::size_t column) const {
  const auto first =
      std::find_if(rows_.begin(), rows_.end(), [](const Row& row) { return !row.is_group; });
  return first != rows_.end() && column < first->cells.size() &&
         first->cells[column].css_class.starts_with("number");
}

std::string Table::attributes_of(const Row& row, std::size_t column) const {
  if (row.is_group) {
    return fmt::format(" scope=\"rowgroup\" class=\"group\" colspan=\"{}\"", columns_.size());
  }
  const Cell& cell = row.cells[column];
  std::string attributes = column == 0 ? " scope=\"row\"" : "";
  if (!cell.css_class.empty()) attributes += fmt::format(" class=\"{}\"", cell.css_class);
  if (is_labelled_ && column > 0) {
    attributes += fmt::format(" data-label=\"{}\"", escape(columns_[column]));
  }
  return attributes;
}

void Table::write_body(Html& html) const {
  html.markup("<tbody>\n");
  for (const Row& row : rows_) {
    html.markup("<tr>");
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const std::string_view tag = i == 0 ? "th" : "td";
      const Cell& cell = row.cells[i];
      html.markup(fmt::format("<{}{}>", tag, attributes_of(row, i)));
      if (cell.address.empty()) {
        html.text(cell.text);
      } else {
        html.link(cell.address, cell.text);
      }
      html.markup(fmt::format("</{}>", tag));
    }
    html.markup("</tr>\n");
  }
  html.markup("</tbody>\n");
}

void write_figure(Html& html, const Figure& figure, const Table& data) {
  html.markup("<figure>\n").element("h3", figure.title);
  html.markup(fmt::format("<div class=\"plot-window\"><div class=\"plot {}\" data-figure=\"{}\" "
                          "data-index=\"{}\" role=\"img\"",
                          figure.size, figure.kind, figure.index))
      .markup(" aria-label=\"")
      .text(figure.description)
      .markup("\"></div></div>\n")
      .element("figcaption", figure.caption)
      .markup("<details class=\"data\" open><summary>The data of this figure</summary>\n");
  data.write(html);
  html.markup("</details>\n</figure>\n");
}

void open_section(Html& html, std::string_view id, std::string_view heading) {
  html.markup(fmt::format("<section id=\"{}\">\n", id)).element("h2", heading);
}

}  // namespace recald::views
