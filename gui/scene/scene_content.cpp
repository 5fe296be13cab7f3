#include "gui/scene/scene_content.h"

#include <QCoreApplication>
#include <algorithm>

#include "gui/workspace/motion_labels.h"

#include "base/error.h"
#include "motion/roles.h"
#include "stats/footsteps.h"

namespace marey::gui {
namespace {

QString tr(const char* text) {
  return QCoreApplication::translate("Scene", text);
}

/// The rate of the models: that of their samples, where there is one.
double modelRate(const Workspace& workspace) {
  for (const MotionGroup& group : workspace.motions().groups())
    if (!group.natural() && !group.motions.empty()) return group.motions.front().clip->fps;
  return workspace.document().experiment().fps;
}

/// Natural scores come in the order of the natural clips, over all natural groups.
const ClipScore* scoreOf(const MotionGroup& group, const MotionId& id,
                         const std::vector<ClipScore>* natural) {
  const auto index = static_cast<size_t>(id.index);
  const Motion& motion = group.motions[index];
  if (motion.score) return &*motion.score;
  if (!group.natural() || !natural || index >= natural->size()) return nullptr;
  return &(*natural)[index];
}

void colourByValue(const Workspace& workspace, const SceneSettings& settings,
                   MotionColouring& colouring, SceneContent& content) {
  const bool likelihood = settings.colourBy == ColourBy::Likelihood;
  const std::string system = naturalSystem(workspace, settings);
  const std::vector<ClipScore>* scores = likelihood ? workspace.natural().scores(system) : nullptr;
  std::vector<ColourSource> sources;
  bool missing = false, natural = false, others = false;
  std::string unit;  // of the scale: that of the first motion that has one
  for (const MotionId& id : content.ids) {
    const MotionGroup& group = *workspace.motions().group(id.group);
    sources.push_back({group.motions[static_cast<size_t>(id.index)].clip, nullptr});
    if (likelihood) sources.back().score = scoreOf(group, id, scores);
    missing = missing || (likelihood && !sources.back().score);
    if (const ClipScore* score = sources.back().score; score && !score->unit.empty()) {
      if (unit.empty()) unit = score->unit;
      others = others || score->unit != unit;
      if (score->unit != unit) sources.back().score = nullptr;
    }
    natural = natural || group.natural();
  }
  const MotionColours& colours = colouring.of(sources, settings.colourBy, modelRate(workspace));
  content.legend.scale = colours.scale;
  content.legend.scaleTitle = !likelihood ? tr("Root speed (m/s)")
                              : unit.empty()
                                  ? tr("Log-likelihood")
                                  : tr("Log-likelihood (%1)").arg(QString::fromStdString(unit));
  QStringList notes;
  if (likelihood && natural && !system.empty())
    notes << tr("Natural motion under %1").arg(QString::fromStdString(system));
  if (others) notes << tr("Grey: in another unit");
  if (missing) notes << tr("Grey: not scored yet");
  content.legend.note = notes.join(QStringLiteral(" · "));
  for (size_t i = 0; i < sources.size(); ++i) {
    const auto known = colours.frames.find(sources[i].clip.get());
    if (known != colours.frames.end())
      content.motions[i].frameColours = known->second;
    else
      content.motions[i].colour = render::grey(0.6);
  }
}

void colourBySample(const Workspace& workspace, SceneContent& content) {
  for (size_t i = 0; i < content.ids.size(); ++i) {
    const MotionGroup& group = *workspace.motions().group(content.ids[i].group);
    const auto last = std::max<double>(1.0, static_cast<double>(group.motions.size()) - 1.0);
    // The scale's yellow end is hard to see on white.
    content.motions[i].colour = scaleColour(0.9 * content.ids[i].index / last);
  }
}

/// The name of the selection's joint; empty without one.
std::string selectedJoint(const Workspace& workspace) {
  const auto& joint = workspace.view().selection().joint;
  const auto skeleton = workspace.motions().skeleton();
  if (!joint || !skeleton || *joint < 0 || *joint >= skeleton->jointCount()) return {};
  return skeleton->names[static_cast<size_t>(*joint)];
}

/// The feet of a body, or none.
std::vector<int> feetOrNone(const Skeleton& body, const std::string& names) {
  try {
    return stats::feetOf(body, names);
  } catch (const InputError&) {
    return {};
  }
}

/// Motions may have different bodies: a joint is the same where it has the same name.
void markJoints(const Workspace& workspace, Trails trails, SceneContent& content) {
  const std::string chosen = selectedJoint(workspace);
  for (render::SceneMotion& motion : content.motions) {
    const Skeleton& body = *motion.clip->skeleton;
    const int joint = chosen.empty() ? -1 : body.find(chosen);
    if (joint >= 0) motion.highlightJoint = joint;
    if (trails == Trails::Feet)
      motion.trailJoints = feetOrNone(body, workspace.document().experiment().feet);
    else if (trails == Trails::SelectedJoint)
      motion.trailJoints = {chosen.empty() ? rolesOf(body).hips : joint};
  }
}

}  // namespace

std::string naturalSystem(const Workspace& workspace, const SceneSettings& settings) {
  if (workspace.document().systemIndex(settings.naturalUnder) >= 0) return settings.naturalUnder;
  const auto& systems = workspace.document().experiment().systems;
  return systems.empty() ? std::string() : systems.front().name;
}

QString groupLabel(const std::string& group, int shown) {
  return QStringLiteral("%1 (%2)").arg(QString::fromStdString(group)).arg(shown);
}

SceneContent sceneContent(const Workspace& workspace, const SceneSettings& settings,
                          MotionColouring& colouring) {
  SceneContent out;
  out.ids = workspace.motions().visibleMotions();
  std::map<int, int> counts;
  for (const MotionId& id : out.ids) {
    const MotionGroup& group = *workspace.motions().group(id.group);
    ++counts[id.group];
    out.motions.push_back({.clip = group.motions[static_cast<size_t>(id.index)].clip,
                           .colour = render::colourOf(group.colourIndex),
                           .opacity = settings.opacity,
                           .highlighted = workspace.view().selected(id),
                           .label = motionLabel(group, id.index).toStdString()});
  }
  for (const MotionGroup& group : workspace.motions().groups())
    if (const int count = counts[group.id]; count > 0)
      out.legend.groups.push_back(
          {render::colourOf(group.colourIndex), groupLabel(group.name, count)});
  if (settings.colourBy == ColourBy::Sample) {
    colourBySample(workspace, out);
    out.legend.note = tr("Colour: number of the sample, from dark to light");
  } else if (settings.colourBy != ColourBy::System) {
    colourByValue(workspace, settings, colouring, out);
  }
  out.legend.groupColours = std::any_of(out.motions.begin(), out.motions.end(),
                                        [](const auto& m) { return m.frameColours.empty(); });
  markJoints(workspace, settings.trails, out);
  return out;
}

}  // namespace marey::gui
