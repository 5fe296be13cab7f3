// The path of the document that is being worked on, sampled, and the one way to edit it.
#pragma once

#include <QObject>
#include <QString>
#include <functional>
#include <optional>

#include "gui/workspace/workspace.h"

#include "experiment/path_curve.h"
#include "motion/path_edit.h"

namespace marey::gui {

/// Follows the workspace; every panel that shows the path has one of its own.
class CurrentPath : public QObject {
  Q_OBJECT
 public:
  explicit CurrentPath(Workspace& workspace, QObject* parent = nullptr);

  /// Null where the document has no path.
  const ExperimentPath* path() const { return m_path ? &*m_path : nullptr; }
  /// Whether it is made of way-points; editing makes it so.
  bool drawn() const { return m_path && !m_path->wayPoints.empty(); }
  /// The way-points, or those that would stand for a preset, a clip or a file.
  const std::vector<WayPoint>& points() const { return m_points; }
  /// All of the path, at the document's rate.
  const PathCurve& curve() const { return m_curve; }
  /// The frames that are sampled: as many seconds as the document asks for.
  const std::vector<RootFrame>& frames() const { return m_frames; }
  /// Where a way-point faces, radians: by its own choice, or as the path has it there.
  double headingAt(size_t wayPoint) const;
  /// The types that way-points may name.
  std::vector<std::string> motionTypes() const { return m_workspace.motionTypes(); }
  /// The frame of curve() at which a way-point is reached.
  size_t frameAt(size_t wayPoint) const;
  /// Why the path cannot be used as it is; empty where all is well.
  const QString& problem() const { return m_problem; }

  /// Changes the way-points under `label`; `amend` while dragging. A path that is not drawn
  /// becomes so.
  void edit(const QString& label, const std::function<void(PathEdit&)>& change, bool amend = false);
  /// A preset, clip or file path becomes way-points.
  void makeDrawn();

 Q_SIGNALS:
  void changed();

 private:
  void refresh();
  void sample();
  void readClipPath();
  void take(std::vector<RootFrame> frames);

  Workspace& m_workspace;
  std::optional<ExperimentPath> m_path;
  double m_fps = 0.0;
  std::filesystem::path m_folder;
  std::vector<WayPoint> m_points;
  PathCurve m_curve;
  std::vector<RootFrame> m_frames;
  QString m_problem;
  int m_version = 0;  ///< so that a clip that was read too late is not taken
};

}  // namespace marey::gui
