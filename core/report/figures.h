// From report data to figures: charts and scenes with their captions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/chart/chart.h"
#include "render/scene/shot.h"
#include "report/report_data.h"

namespace marey::report {

/// A chart or a scene (exactly one of the two).
struct Figure {
  std::string id;  ///< file name without extension, unique
  Section section = Section::Motion;
  std::string title, caption;
  std::optional<render::ChartGrid> chart = std::nullopt;
  render::ChartSize size = {};
  std::optional<render::Shot> scene = std::nullopt;
};

/// The colour of a system: near-black for natural motion.
render::Colour systemColour(const ReportSystem& system);
/// Every figure of a report in reading order. Panels without data give no figure.
std::vector<Figure> figuresOf(const ReportData& data);

// The parts, one per kind of panel.
Figure sceneFigure(const ReportData& data, const ScenePanel& panel, int number);
Figure likelihoodFigure(const ReportData& data, const LikelihoodPanel& panel, int number);
Figure footstepFigure(const ReportData& data);
Figure gaitFigure(const ReportData& data, const GaitPanel& panel, int number);
/// One figure for all joints of one quantity.
Figure distributionFigure(const ReportData& data, const std::string& quantity);

}  // namespace marey::report
