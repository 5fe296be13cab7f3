#include "render/base/drawing.h"

#include <cmath>

#include "base/error.h"

namespace marey::render {

Drawing::Drawing(cairo_t* context, std::vector<TextRecord>* texts)
    : m_context(context), m_texts(texts) {
  // Unhinted outlines and metrics: the same text at any scale and on any surface.
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(m_context, options);
  cairo_font_options_destroy(options);
  cairo_set_line_join(m_context, CAIRO_LINE_JOIN_ROUND);
}

void Drawing::setColour(const Colour& colour) {
  const Colour c = themed(colour, m_theme);
  cairo_set_source_rgba(m_context, c.r, c.g, c.b, c.a);
}

void Drawing::setFont(const TextStyle& style) {
  cairo_select_font_face(m_context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(m_context, style.size);
}

void Drawing::fillBox(const Box& box, const Colour& colour) {
  setColour(colour);
  cairo_rectangle(m_context, box.left, box.top, box.width(), box.height());
  cairo_fill(m_context);
}

void Drawing::strokeBox(const Box& box, const Colour& colour, double width) {
  setColour(colour);
  cairo_set_line_width(m_context, width);
  cairo_rectangle(m_context, box.left, box.top, box.width(), box.height());
  cairo_stroke(m_context);
}

void Drawing::line(Point a, Point b, const Colour& colour, double width, bool dashed) {
  polyline({a, b}, colour, width, dashed);
}

void Drawing::polyline(const std::vector<Point>& points, const Colour& colour, double width,
                       bool dashed) {
  setColour(colour);
  cairo_set_line_width(m_context, width);
  const double dashes[2] = {4.0 * width, 2.5 * width};
  cairo_set_dash(m_context, dashes, dashed ? 2 : 0, 0.0);
  bool broken = true;
  for (const Point& p : points) {
    const bool finite = std::isfinite(p.x) && std::isfinite(p.y);
    if (finite && broken) cairo_move_to(m_context, p.x, p.y);
    if (finite && !broken) cairo_line_to(m_context, p.x, p.y);
    broken = !finite;
  }
  cairo_stroke(m_context);
  cairo_set_dash(m_context, nullptr, 0, 0.0);
}

void Drawing::polygon(const std::vector<Point>& points, const Colour& colour) {
  if (points.empty()) return;
  setColour(colour);
  cairo_move_to(m_context, points.front().x, points.front().y);
  for (const Point& p : points) cairo_line_to(m_context, p.x, p.y);
  cairo_close_path(m_context);
  cairo_fill(m_context);
}

void Drawing::disc(Point centre, double radius, const Colour& fill) {
  setColour(fill);
  cairo_new_sub_path(m_context);
  cairo_arc(m_context, centre.x, centre.y, radius, 0.0, 2.0 * M_PI);
  cairo_fill(m_context);
}

void Drawing::ring(Point centre, double radius, const Colour& colour, double width) {
  setColour(colour);
  cairo_set_line_width(m_context, width);
  cairo_new_sub_path(m_context);
  cairo_arc(m_context, centre.x, centre.y, radius, 0.0, 2.0 * M_PI);
  cairo_stroke(m_context);
}

double Drawing::textWidth(const std::string& text, const TextStyle& style) {
  setFont(style);
  cairo_text_extents_t extents;
  cairo_text_extents(m_context, text.c_str(), &extents);
  return extents.x_advance;
}

void Drawing::text(const std::string& text, Point at, const TextStyle& style) {
  if (m_texts != nullptr) {
    TextStyle drawn = style;
    drawn.colour = themed(style.colour, m_theme);
    m_texts->push_back({text, at, drawn, themed({1, 1, 1, 1}, m_theme)});
    return;
  }
  const double width = textWidth(text, style);
  const double share = style.align == Align::Left ? 0.0 : style.align == Align::Centre ? 0.5 : 1.0;
  cairo_save(m_context);
  cairo_translate(m_context, at.x, at.y);
  cairo_rotate(m_context, style.turn);
  if (style.halo) {
    setColour({1, 1, 1, 0.85});
    cairo_set_line_width(m_context, 3.5);
    cairo_move_to(m_context, -share * width, 0.0);
    cairo_text_path(m_context, text.c_str());
    cairo_stroke(m_context);
  }
  setColour(style.colour);
  cairo_move_to(m_context, -share * width, 0.0);
  cairo_show_text(m_context, text.c_str());
  cairo_restore(m_context);
}

void Drawing::clipTo(const Box& box) {
  cairo_save(m_context);
  cairo_rectangle(m_context, box.left, box.top, box.width(), box.height());
  cairo_clip(m_context);
}

void Drawing::endClip() {
  cairo_restore(m_context);
}

Canvas::Canvas(int width, int height, double scale)
    : m_surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32,
                                           static_cast<int>(std::lround(width * scale)),
                                           static_cast<int>(std::lround(height * scale)))),
      m_context(cairo_create(m_surface)) {
  if (cairo_status(m_context) != CAIRO_STATUS_SUCCESS) {
    const std::string reason = cairo_status_to_string(cairo_status(m_context));
    cairo_destroy(m_context);
    cairo_surface_destroy(m_surface);
    throw NumericError(fmt::format("no picture of {}x{} pixels: {}", width, height, reason));
  }
  cairo_scale(m_context, scale, scale);
}

Canvas::Canvas(const Image& image) : Canvas(image.width, image.height) {
  cairo_surface_flush(m_surface);
  uint8_t* data = cairo_image_surface_get_data(m_surface);
  const int stride = cairo_image_surface_get_stride(m_surface);
  for (int y = 0; y < image.height; ++y) {
    const uint8_t* from = image.at(0, y);
    uint8_t* to = data + static_cast<size_t>(y) * stride;
    for (int x = 0; x < image.width; ++x, from += 4, to += 4) {
      // cairo holds premultiplied blue, green, red, alpha on little-endian machines.
      const int alpha = from[3];
      to[0] = static_cast<uint8_t>((from[2] * alpha + 127) / 255);
      to[1] = static_cast<uint8_t>((from[1] * alpha + 127) / 255);
      to[2] = static_cast<uint8_t>((from[0] * alpha + 127) / 255);
      to[3] = from[3];
    }
  }
  cairo_surface_mark_dirty(m_surface);
}

Canvas::~Canvas() {
  cairo_destroy(m_context);
  cairo_surface_destroy(m_surface);
}

Image Canvas::image() const {
  cairo_surface_flush(m_surface);
  Image image(cairo_image_surface_get_width(m_surface), cairo_image_surface_get_height(m_surface));
  const uint8_t* data = cairo_image_surface_get_data(m_surface);
  const int stride = cairo_image_surface_get_stride(m_surface);
  for (int y = 0; y < image.height; ++y) {
    const uint8_t* from = data + static_cast<size_t>(y) * stride;
    uint8_t* to = image.at(0, y);
    for (int x = 0; x < image.width; ++x, from += 4, to += 4) {
      const int alpha = from[3];
      const auto straight = [&](int v) {
        return static_cast<uint8_t>(alpha == 0 ? 0 : std::min(255, (v * 255 + alpha / 2) / alpha));
      };
      to[0] = straight(from[2]);
      to[1] = straight(from[1]);
      to[2] = straight(from[0]);
      to[3] = from[3];
    }
  }
  return image;
}

}  // namespace marey::render
