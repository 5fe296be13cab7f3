// Private to the folder: a thin layer over cairo with the few strokes that figures need.
#pragma once

#include <string>
#include <vector>

#include <cairo.h>

#include "render/base/chart_theme.h"
#include "render/base/colours.h"
#include "render/base/image.h"

namespace marey::render {

struct Point {
  double x = 0.0, y = 0.0;
};

struct Box {
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
  double width() const { return right - left; }
  double height() const { return bottom - top; }
};

enum class Align { Left, Centre, Right };

struct TextStyle {
  double size = 12.0;  ///< pixels
  Colour colour = {0.2, 0.2, 0.2, 1.0};
  Align align = Align::Left;
  bool bold = false;
  double turn = 0.0;  ///< radians, clockwise on the page
  bool halo = false;  ///< a rim in the colour of the page, for text over lines
};

/// A text that was left to the caller: cairo's SVG surface turns text into outlines, which nobody
/// can search or copy.
struct TextRecord {
  std::string text;
  Point at;
  TextStyle style;  ///< colour as drawn: the theme has been applied
  Colour halo = {1, 1, 1, 1};
};

/// Draws on a cairo context that someone else owns.
class Drawing {
 public:
  /// With `texts`, texts are collected there (in order, in page coordinates) and not drawn.
  explicit Drawing(cairo_t* context, std::vector<TextRecord>* texts = nullptr);

  /// Colours are given as for white paper; a theme replaces them as they are drawn.
  void setTheme(const ChartTheme& theme) { m_theme = theme; }
  const ChartTheme& theme() const { return m_theme; }

  void fillBox(const Box& box, const Colour& colour);
  void strokeBox(const Box& box, const Colour& colour, double width);
  void line(Point a, Point b, const Colour& colour, double width, bool dashed = false);
  /// NaN points break the line.
  void polyline(const std::vector<Point>& points, const Colour& colour, double width,
                bool dashed = false);
  void polygon(const std::vector<Point>& points, const Colour& colour);
  void disc(Point centre, double radius, const Colour& fill);
  void ring(Point centre, double radius, const Colour& colour, double width);
  /// `at` is on the base line.
  void text(const std::string& text, Point at, const TextStyle& style);
  double textWidth(const std::string& text, const TextStyle& style);
  void clipTo(const Box& box);
  void endClip();
  cairo_t* context() const { return m_context; }

 private:
  void setColour(const Colour& colour);
  void setFont(const TextStyle& style);

  cairo_t* m_context;
  std::vector<TextRecord>* m_texts;
  ChartTheme m_theme;
};

/// A cairo image surface to draw on, and its pixels as an Image (or an Image to draw over).
class Canvas {
 public:
  Canvas(int width, int height, double scale = 1.0);
  explicit Canvas(const Image& image);
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;
  ~Canvas();

  cairo_t* context() const { return m_context; }
  Image image() const;

 private:
  cairo_surface_t* m_surface;
  cairo_t* m_context;
};

}  // namespace marey::render
