/// Drawing primitives that write plain SVG: rectangles, lines, curves and text, without scripts or
/// external fonts. Coordinates are pixels, x to the right and y downwards.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace recald::simulators {

struct Point {
  double x;
  double y;
};

struct Segment {
  Point from;
  Point to;
};

struct Box {
  double left;
  double top;
  double width;
  double height;

  [[nodiscard]] double right() const { return left + width; }
  [[nodiscard]] double bottom() const { return top + height; }
};

inline constexpr std::string_view kInk = "#24292f";
inline constexpr std::string_view kFaintInk = "#656d76";
inline constexpr std::string_view kGridInk = "#e3e6e9";

struct Stroke {
  std::string_view colour = kInk;
  double width = 1.0;
  bool dashed = false;
};

enum class Anchor { start, middle, end };

struct TextStyle {
  double size = 12.0;
  std::string_view colour = kInk;
  Anchor anchor = Anchor::start;
  bool bold = false;
};

/// Escapes text and attributes for XML.
[[nodiscard]] std::string escape_xml(std::string_view text);

/// Approximate largest width of a text: widths by class of letter of DejaVu Sans, the widest font
/// that replaces Helvetica if that is missing. Handles UTF-8.
[[nodiscard]] double text_width(std::string_view text, double size);

/// Lines no wider than `width` if words allow it; a wider word has its own line. Empty
/// text has no lines.
[[nodiscard]] std::vector<std::string> wrap_text(std::string_view text, double size, double width);

/// "+1.2", "−0.4", "0", with a typographic minus. Rounded to `decimals`.
[[nodiscard]] std::string signed_number(double value, int decimals);

/// A figure on its own white background with rounded corners, so that it is readable on any page.
class Svg {
 public:
  /// @param title  Read aloud to people who cannot see the figure.
  Svg(double width, double height, std::string_view title);

  void rectangle(const Box& box, std::string_view fill);
  void line(Point from, Point to, const Stroke& stroke);
  /// All lines of one kind, as one path.
  void lines(std::span<const Segment> segments, const Stroke& stroke);
  /// Points are rounded to a tenth of a pixel and written as steps from one to the next, which is
  /// short. Fewer than two points draw nothing.
  void curve(std::span<const Point> points, const Stroke& stroke);
  /// All boxes of one colour, as one path.
  void boxes(std::span<const Box> boxes, std::string_view fill);
  /// @param at  Start, middle or end of the base line, depending on the style.
  void text(Point at, std::string_view text, const TextStyle& style = {});

  [[nodiscard]] std::string finished() const;

 private:
  std::string body_;
};

}  // namespace recald::simulators
