#include "simulators/footprint/svg.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace recald::simulators {
namespace {

/// Rounded to a tenth, as short as possible, and never "-0".
std::string px(double value) { return fmt::format("{}", std::round(value * 10.0) / 10.0 + 0.0); }

/// In tenths of a pixel.
struct Tenths {
  long x;
  long y;
};

Tenths tenths(Point point) { return {std::lround(point.x * 10.0), std::lround(point.y * 10.0)}; }

/// Relative to the letter size.
double letter_width(char letter) {
  constexpr std::string_view narrow = " .,:;'|!iljtfrI()[]/";
  constexpr std::string_view wide = "mwMW%@";
  if (narrow.find(letter) != std::string_view::npos) return 0.35;
  if (wide.find(letter) != std::string_view::npos) return 0.93;
  return letter >= 'A' && letter <= 'Z' ? 0.71 : 0.62;
}

/// UTF-8 writes a letter as one leading byte and continuation bytes 10xxxxxx.
bool continues_letter(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

/// @param unit  of the coordinates, in pixels
std::string stroke_attributes(const Stroke& stroke, double unit = 1.0) {
  const std::string dashes =
      fmt::format(R"( stroke-dasharray="{} {}")", px(4.0 / unit), px(3.0 / unit));
  return fmt::format(R"(stroke="{}" stroke-width="{}"{})", stroke.colour, px(stroke.width / unit),
                     stroke.dashed ? dashes : "");
}

}  // namespace

std::string escape_xml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

double text_width(std::string_view text, double size) {
  double width = 0.0;
  for (const char c : text) {
    if (!continues_letter(c)) width += letter_width(c);
  }
  return size * width;
}

std::vector<std::string> wrap_text(std::string_view text, double size, double width) {
  std::vector<std::string> lines;
  std::size_t at = text.find_first_not_of(' ');
  while (at != std::string_view::npos) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word(text.substr(at, end - at));
    if (!lines.empty() && text_width(lines.back() + ' ' + word, size) <= width) {
      lines.back() += ' ' + word;
    } else {
      lines.push_back(word);
    }
    at = text.find_first_not_of(' ', end);
  }
  return lines;
}

std::string signed_number(double value, int decimals) {
  const std::string digits = fmt::format("{:.{}f}", std::abs(value), decimals);
  if (digits.find_first_not_of("0.") == std::string::npos) return "0";
  return (value < 0.0 ? "\u2212" : "+") + digits;
}

Svg::Svg(double width, double height, std::string_view title) {
  body_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\" font-family=\"Helvetica, Arial, sans-serif\" role=\"img\">\n"
      "<title>{2}</title>\n<rect width=\"{0}\" height=\"{1}\" rx=\"8\" fill=\"#ffffff\"/>\n",
      px(width), px(height), escape_xml(title));
}

void Svg::rectangle(const Box& box, std::string_view fill) {
  fmt::format_to(std::back_inserter(body_),
                 "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n", px(box.left),
                 px(box.top), px(box.width), px(box.height), fill);
}

void Svg::line(Point from, Point to, const Stroke& stroke) {
  const Segment segment{from, to};
  lines({&segment, 1}, stroke);
}

void Svg::lines(std::span<const Segment> segments, const Stroke& stroke) {
  std::string path;
  for (const auto& [from, to] : segments) {
    fmt::format_to(std::back_inserter(path), "M{} {}L{} {}", px(from.x), px(from.y), px(to.x),
                   px(to.y));
  }
  fmt::format_to(std::back_inserter(body_), "<path d=\"{}\" {}/>\n", path,
                 stroke_attributes(stroke));
}

void Svg::curve(std::span<const Point> points, const Stroke& stroke) {
  if (points.size() < 2) return;
  Tenths before = tenths(points.front());
  std::string path = fmt::format("M{} {}l", before.x, before.y);
  // A minus separates numbers as well as a blank does.
  const auto append = [&path](long step) {
    if (step >= 0 && path.back() != 'l') path += ' ';
    path += std::to_string(step);
  };
  for (const Point& point : points.subspan(1)) {
    const Tenths now = tenths(point);
    append(now.x - before.x);
    append(now.y - before.y);
    before = now;
  }
  fmt::format_to(std::back_inserter(body_),
                 "<path d=\"{}\" transform=\"scale(.1)\" fill=\"none\" stroke-linejoin=\"round\" "
                 "{}/>\n",
                 path, stroke_attributes(stroke, 0.1));
}

void Svg::boxes(std::span<const Box> boxes, std::string_view fill) {
  if (boxes.empty()) return;
  std::string path;
  for (const Box& box : boxes) {
    fmt::format_to(std::back_inserter(path), "M{} {}h{}v{}h{}z", px(box.left), px(box.top),
                   px(box.width), px(box.height), px(-box.width));
  }
  fmt::format_to(std::back_inserter(body_), "<path d=\"{}\" fill=\"{}\"/>\n", path, fill);
}

void Svg::text(Point at, std::string_view text, const TextStyle& style) {
  const std::string_view anchor = style.anchor == Anchor::start    ? ""
                                  : style.anchor == Anchor::middle ? R"( text-anchor="middle")"
                                                                   : R"( text-anchor="end")";
  fmt::format_to(std::back_inserter(body_),
                 "<text x=\"{}\" y=\"{}\" font-size=\"{}\" fill=\"{}\"{}{}>{}</text>\n", px(at.x),
                 px(at.y), px(style.size), style.colour, anchor,
                 style.bold ? R"( font-weight="bold")" : "", escape_xml(text));
}

std::string Svg::finished() const { return body_ + "</svg>\n"; }

}  // namespace recald::simulators
