#include "gui/path/current_path.h"

#include <QPointer>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "experiment/path_choice.h"

namespace marey::gui {

CurrentPath::CurrentPath(Workspace& workspace, QObject* parent)
    : QObject(parent), m_workspace(workspace) {
  connect(&workspace.document(), &Document::changed, this, &CurrentPath::refresh);
  connect(&workspace.document(), &Document::currentPathChanged, this, &CurrentPath::refresh);
  refresh();
}

void CurrentPath::refresh() {
  const Experiment& experiment = m_workspace.document().experiment();
  const int index = m_workspace.document().currentPath();
  std::optional<ExperimentPath> path;
  if (index >= 0 && index < static_cast<int>(experiment.paths.size()))
    path = experiment.paths[static_cast<size_t>(index)];
  if (path == m_path && m_fps == experiment.fps && m_folder == experiment.folder) return;
  m_path = std::move(path);
  m_fps = experiment.fps;
  m_folder = experiment.folder;
  ++m_version;
  m_problem.clear();
  if (!m_path)
    take({});
  else if (!drawn() && m_path->path.rfind("clip:", 0) == 0)
    readClipPath();
  else
    sample();
}

void CurrentPath::sample() {
  std::vector<RootFrame> frames;
  try {
    if (drawn())
      frames = samplePath(m_path->wayPoints, m_fps, m_path->name);
    else
      frames = rootFramesOf({.path = m_path->path, .seconds = m_path->seconds, .folder = m_folder},
                            m_fps);
  } catch (const std::exception& error) {
    m_problem = QString::fromUtf8(error.what());
  }
  take(std::move(frames));
}

void CurrentPath::readClipPath() {
  // A clip may take a while to read: the old line goes at once, the new one comes when it is there.
  take({});
  m_problem = tr("Reading the clip …");
  const auto frames = std::make_shared<std::vector<RootFrame>>();
  const auto error = std::make_shared<QString>();
  const PathChoice choice{.path = m_path->path, .seconds = m_path->seconds, .folder = m_folder};
  const double fps = m_fps;
  const auto work = [frames, error, choice, fps](Progress&) {
    try {
      *frames = rootFramesOf(choice, fps);
    } catch (const std::exception& failure) {
      // Shown with the path instead of in a message of its own.
      *error = QString::fromUtf8(failure.what());
    }
  };
  const QPointer<CurrentPath> self = this;
  const auto done = [self, frames, error, version = m_version] {
    if (!self || self->m_version != version) return;
    self->m_problem = *error;
    self->take(std::move(*frames));
  };
  m_workspace.jobs().start(Lane::Files, tr("Read the path's clip"), work, done);
}

void CurrentPath::take(std::vector<RootFrame> frames) {
  m_frames = frames;
  m_curve = curveOf(std::move(frames), m_fps);
  m_points.clear();
  if (drawn()) {
    m_points = m_path->wayPoints;
    const double wanted = m_path->seconds;
    const auto count = static_cast<size_t>(std::max(2L, std::lround(wanted * m_fps)));
    if (wanted > 0.0 && !m_frames.empty()) {
      if (count > m_frames.size() + 1)
        m_problem = tr("%1 s are asked for, but the path ends after %2 s: slow it down, draw it "
                       "further, or set its seconds to “whole path”.")
                        .arg(wanted)
                        .arg(m_curve.seconds(), 0, 'f', 2);
      m_frames.resize(std::min(count, m_frames.size()));
    }
  } else if (m_frames.size() > 1) {
    m_points = fitWayPoints(m_frames, m_fps);
  }
  Q_EMIT changed();
}

void CurrentPath::edit(const QString& label, const std::function<void(PathEdit&)>& change,
                       bool amend) {
  if (!m_path || m_points.size() < 2) return;
  const auto index = static_cast<size_t>(m_workspace.document().currentPath());
  const std::vector<WayPoint> points = m_points;
  m_workspace.document().edit(
      label,
      [&](Experiment& experiment) {
        PathEdit edit(points);
        change(edit);
        ExperimentPath& path = experiment.paths.at(index);
        if (path.wayPoints.empty()) path.seconds = 0.0;
        path.path.clear();
        path.startFromClip = false;
        path.wayPoints = edit.points();
      },
      amend);
}

double CurrentPath::headingAt(size_t wayPoint) const {
  const WayPoint& point = m_points.at(wayPoint);
  if (point.facing) return *point.facing;
  return m_curve.frames.empty() ? 0.0 : m_curve.frames[frameAt(wayPoint)].heading;
}

size_t CurrentPath::frameAt(size_t wayPoint) const {
  const double time = m_points[wayPoint].timeS.value_or(arrivalTimes(m_points)[wayPoint]);
  const double start = m_points.front().timeS.value_or(0.0);
  const auto frame = static_cast<size_t>(std::max(0L, std::lround((time - start) * m_curve.fps)));
  return std::min(frame, std::max<size_t>(1, m_curve.frames.size()) - 1);
}

void CurrentPath::makeDrawn() {
  if (!drawn()) edit(tr("Make path editable"), [](PathEdit&) {});
}

}  // namespace marey::gui
