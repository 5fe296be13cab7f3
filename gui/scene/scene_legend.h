// Legend and colour bar of the 3D view and of pictures of it.
#pragma once

#include <QPainter>
#include <QSize>

#include "gui/common/paint_style.h"
#include "gui/scene/scene_content.h"

#include "render/base/image.h"

namespace marey::gui {

/// Groups in the upper left corner, the colour bar in the lower right one of an area from (0, 0).
void paintSceneLegend(QPainter& painter, const SceneLegend& legend, const QSize& area,
                      const Inks& inks, bool dark);

/// The same alone, on nothing, for pictures of this size; letters grow with the height.
render::Image legendPicture(const SceneLegend& legend, int width, int height, bool dark);

}  // namespace marey::gui
