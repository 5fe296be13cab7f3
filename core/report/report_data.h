// What a report shows, as plain data: no model, no file, no drawing. Whoever compares systems fills
// one of these; the same values could fill a window.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "motion/clip.h"
#include "motion/features.h"
#include "render/base/recipe.h"
#include "render/scene/scene.h"

namespace marey::report {

/// A source of motion: natural data, or a model under one setting. Panels name systems by their
/// index in ReportData::systems.
struct ReportSystem {
  std::string name;
  int colourIndex = 0;  ///< of render::colourOf; natural motion is always near-black
  bool natural = false;
  /// Clips by the name of the path that they follow; world metres.
  std::map<std::string, std::vector<std::shared_ptr<const Clip>>> clips = {};
};

/// A picture of all systems on one path.
struct ScenePanel {
  std::string path;  ///< key of ReportSystem::clips
  std::string title;
  std::vector<RootFrame> line = {};  ///< the wanted path on the floor; empty: none drawn
  render::View view = render::View::ThreeQuarter;
  bool orthographic = false;
  double strobeS = 0.0;    ///< a figure every so many seconds; 0: so that they stand apart
  int clipsPerSystem = 3;  ///< the first ones are drawn
  double seconds = 0.0;    ///< only this much from the start; 0: all
};

/// Values of one system in a panel.
struct SystemSamples {
  int system = 0;
  std::vector<double> values;
};

/// How often a joint has which value.
struct DistributionPanel {
  std::string joint;     ///< "LeftFoot"
  std::string quantity;  ///< "speed"
  std::string unit;      ///< "cm/s"
  std::vector<SystemSamples> samples;
};

/// Log-likelihood of many runs over time.
struct LikelihoodGroup {
  int system = 0;
  std::vector<std::vector<double>>
      nats;  ///< runs x frames, in the panel's unit; NaN where not scored
};
struct LikelihoodPanel {
  std::string title;
  std::string unit = {};  ///< "nats per frame, cm": of one model, hence one
  double fps = 20.0;
  std::vector<LikelihoodGroup> groups;
  std::optional<double> linearGaussianNats;  ///< of the natural clips, where the model has one
  std::string note;                          ///< what the numbers hang on, what was left out
};

/// Footsteps counted at every speed tolerance.
struct FootstepSeries {
  int system = 0;
  std::vector<double> toleranceCmS;
  std::vector<double> count;
  double v95CmS = 0.0;  ///< NaN: none
};
struct FootstepPanel {
  std::string title;
  std::vector<FootstepSeries> curves;
};

/// When feet are on the floor.
struct GaitRow {
  int system = 0;
  std::string foot;                                  ///< "LeftFoot"
  std::vector<std::pair<double, double>> contactsS;  ///< begin, end
};
struct GaitPanel {
  std::string title;
  double seconds = 0.0;
  std::vector<GaitRow> rows;
};

enum class Section { Summary, Motion, Likelihood, Footsteps, Distributions, Statistics };

struct Column {
  std::string name;
  std::string unit = {};  ///< "" for none
  std::string note = {};  ///< definition, shown below the table
};
/// Text, or a number with its text form (rounded for people; files keep the number).
struct Cell {
  std::string text;
  std::optional<double> number = std::nullopt;
};
/// A number with `decimals` digits; NaN is shown as a dash.
Cell numberCell(double value, int decimals);

struct Table {
  std::string id;  ///< file name: letters, digits, - and _
  std::string title, caption;
  Section section = Section::Statistics;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
};

struct Note {
  std::string title, text;  ///< paragraphs are separated by an empty line
};

struct ReportData {
  std::string title;
  std::string summary;    ///< a few sentences at the top
  render::Recipe recipe;  ///< version, command, seed, model and experiment hash, temperature, ...
  std::vector<ReportSystem> systems;
  std::vector<ScenePanel> scenes;
  std::vector<LikelihoodPanel> likelihoods;
  std::vector<FootstepPanel> footsteps;
  std::vector<GaitPanel> gaits;
  std::vector<DistributionPanel> distributions;
  std::vector<Table> tables;
  std::vector<Note> notes;
};

/// Throws InputError naming the panel: a system index out of range, rows of other lengths than the
/// columns, an unusable or repeated table id, a scene without clips.
void validate(const ReportData& data);

}  // namespace marey::report
