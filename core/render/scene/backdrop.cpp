#include "render/scene/backdrop.h"

namespace marey::render {

namespace {
constexpr Colour rgb(int r, int g, int b) {
  return {r / 255.0, g / 255.0, b / 255.0, 1.0};
}
}  // namespace

const Backdrop& backdropOf(Tone tone) {
  static const Backdrop light{rgb(236, 239, 243), rgb(248, 249, 251), rgb(206, 212, 220),
                              rgb(110, 120, 133), 0.75};
  static const Backdrop dark{rgb(22, 26, 33), rgb(34, 39, 48), rgb(58, 66, 79), rgb(150, 162, 178),
                             1.0};
  static const Backdrop paper{rgb(255, 255, 255), rgb(245, 246, 248), rgb(223, 226, 231),
                              rgb(120, 126, 134), 0.75};
  if (tone == Tone::Paper) return paper;
  return tone == Tone::Dark ? dark : light;
}

}  // namespace marey::render
