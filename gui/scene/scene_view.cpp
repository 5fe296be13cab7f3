#include "gui/scene/scene_view.h"

#include <QCoreApplication>
#include <QSurfaceFormat>
#include <algorithm>
#include <utility>

#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include "base/error.h"

namespace marey::gui {
namespace {

/// Names under the mouse are looked up when it rests this long: every look-up visits every joint.
constexpr int kHoverMs = 40;

}  // namespace

SceneView::SceneView(Workspace& workspace, std::shared_ptr<ShownScene> shown, QWidget* parent)
    : QVTKOpenGLNativeWidget(parent),
      m_workspace(workspace),
      m_path(new CurrentPath(workspace, this)),
      m_tool(*m_path, m_scene),
      m_colouring(new MotionColouring(workspace, this)),
      m_shown(std::move(shown)) {
  setObjectName(QStringLiteral("sceneView"));
  setMinimumSize(240, 180);
  setMouseTracking(true);
  // With a native window of its own a new frame composes this view alone, not the whole window.
  setAttribute(Qt::WA_DontCreateNativeAncestors);
  setAttribute(Qt::WA_NativeWindow);
  setFocusPolicy(Qt::StrongFocus);
  setAccessibleName(tr("3D view of the motions"));
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  window->SetMultiSamples(0);
  setRenderWindow(window);
  // The mouse is handled here; VTK's own style would move the camera a second time.
  if (window->GetInteractor()) window->GetInteractor()->SetInteractorStyle(nullptr);
  window->AddRenderer(m_scene.renderer());
  m_overlay = new SceneOverlay(this);
  m_overlay->setContent(&m_content);
  m_overlay->setTool(
      [this](QPainter& painter, const Inks& inks) { m_tool.paint(painter, size(), inks); });
  m_hover.setSingleShot(true);
  m_hover.setInterval(kHoverMs);
  connect(&m_hover, &QTimer::timeout, this, &SceneView::updateHover);
  connectWorkspace();
  schedule();
}

void SceneView::prepareApplication() {
  QCoreApplication::setAttribute(Qt::AA_DontCreateNativeWidgetSiblings);
  QSurfaceFormat format = QVTKOpenGLNativeWidget::defaultFormat();
  format.setSamples(0);
  // Lines wider than a pixel are deprecated, and crowds are drawn with them.
  format.setOption(QSurfaceFormat::DeprecatedFunctions);
  QSurfaceFormat::setDefaultFormat(format);
}

SceneView::~SceneView() {
  // The scene lets go of what it has on the graphics card, which needs the context.
  if (context() != nullptr) makeCurrent();
  renderWindow()->RemoveRenderer(m_scene.renderer());
}

void SceneView::connectWorkspace() {
  for (const auto changed : {&MotionGroups::changed, &MotionGroups::visibilityChanged})
    connect(&m_workspace.motions(), changed, this, &SceneView::changeMotions);
  connect(&m_workspace.natural(), &NaturalMotions::scoresChanged, this, &SceneView::changeMotions);
  connect(&m_workspace.view(), &View::selectionChanged, this, &SceneView::changeMotions);
  connect(&m_workspace.document(), &Document::changed, this, &SceneView::changeMotions);
  connect(&m_workspace.view(), &View::timeChanged, this, [this](double seconds) {
    m_scene.setTime(seconds);
    schedule();
  });
  connect(m_colouring, &MotionColouring::changed, this, &SceneView::changeMotions);
  connect(m_path, &CurrentPath::changed, this, &SceneView::changeOptions);
  connect(&m_workspace.view(), &View::contactToleranceChanged, this, &SceneView::changeOptions);
}

void SceneView::changeMotions() {
  m_motionsChanged = true;
  changeOptions();
}

void SceneView::changeOptions() {
  m_optionsChanged = true;
  schedule();
}

void SceneView::schedule() {
  if (m_redrawPosted) return;
  m_redrawPosted = true;
  // Posted rather than timed: it comes before the window's own painting, which would otherwise
  // compose the whole window once with the old scene and once more with the new one.
  QMetaObject::invokeMethod(
      this,
      [this] {
        if (m_redrawPosted) flush();
      },
      Qt::QueuedConnection);
}

void SceneView::flush() {
  m_redrawPosted = false;
  // Nothing is worked out for a view that is not seen; showing it comes back here.
  if (!isVisible()) return;
  if (m_motionsChanged) updateMotions();
  if (m_optionsChanged) updateOptions();
  if (m_motionsChanged) m_shown->motions = m_scene.motions();
  m_motionsChanged = m_optionsChanged = false;
  fitNew();
  updateHint();
  tellShown();
  if (isValid()) renderWindow()->Render();
  m_overlay->update();
}

void SceneView::tellShown() {
  m_shown->options = m_scene.options();
  m_shown->viewpoint = m_scene.viewpoint();
  m_shown->follow = m_scene.follow();
  m_shown->timeS = m_scene.time();
  m_shown->colourBy = m_settings.colourBy;
  m_shown->legend = m_content.legend;
  const double ratio = devicePixelRatioF();
  m_shown->width = static_cast<int>(ratio * width());
  m_shown->height = static_cast<int>(ratio * height());
}

void SceneView::updateMotions() {
  m_trouble.clear();
  SceneContent next = sceneContent(m_workspace, m_settings, *m_colouring);
  try {
    m_scene.setMotions(next.motions);
  } catch (const Error& error) {
    if (m_settings.placement == render::Placement::World) {
      m_trouble = QString::fromUtf8(error.what());
      return;  // what is drawn, and may be picked, is what was there before
    }
    fallBack(error.what());
    try {
      m_scene.setMotions(next.motions);
    } catch (const Error& other) {
      m_trouble = QString::fromUtf8(other.what());
      return;
    }
  }
  m_content = std::move(next);
  m_scene.setTime(m_workspace.view().time());
}

/// Every motion can be drawn where it is.
void SceneView::fallBack(const std::string& why) {
  m_trouble = QString::fromStdString(why);
  m_settings.placement = render::Placement::World;
  render::SceneOptions options = m_scene.options();
  options.placement = render::Placement::World;
  m_scene.setOptions(options);
  Q_EMIT settingsReplaced();
}

void SceneView::fitNew() {
  const size_t count = m_content.motions.size();
  const bool path = !m_path->frames().empty();
  // More motions widen the view until the user has moved the camera; fewer leave it alone. A
  // path alone is looked at once, so that editing it does not move the floor under the mouse.
  const bool more = count > m_fittedMotions || (path && !m_fittedPath && count == 0);
  if (more && !m_cameraKept && (!m_cameraMoved || m_fittedMotions == 0))
    m_scene.setView(render::View::ThreeQuarter, width(), height());
  m_fittedMotions = count;
  m_fittedPath = path;
}

void SceneView::updateOptions() {
  render::SceneOptions options;
  options.placement = m_settings.placement;
  options.detail = m_settings.detail;
  options.strobe.everyS = m_settings.ghostFrames > 0
                              ? m_settings.ghostFrames / m_workspace.document().experiment().fps
                              : m_settings.ghostsS;
  options.trailS = m_settings.trailS;
  options.contactMarks = m_settings.contacts;
  options.contacts = m_workspace.contactRule();
  options.shadow = m_settings.shadow;
  if (m_settings.path) options.path = m_path->frames();
  options.tone = isDark(palette()) ? render::Tone::Dark : render::Tone::Light;
  try {
    m_scene.setOptions(options);
  } catch (const Error& error) {
    fallBack(error.what());
    options.placement = render::Placement::World;
    m_scene.setOptions(options);
  }
}

void SceneView::updateHint() {
  const bool empty = m_content.motions.empty();
  QString hint;
  const auto& groups = m_workspace.motions().groups();
  // The natural group is there before any clip of it.
  const bool nothing = std::all_of(groups.begin(), groups.end(),
                                   [](const MotionGroup& g) { return g.motions.empty(); });
  if (empty && nothing)
    hint = tr("Open motion files, or sample a model along the path, to see motions here.");
  else if (empty)
    hint = tr("All motions are hidden. Show some in the Motions panel.");
  m_overlay->setHint(m_tool.active() ? QString() : hint);
  QString mode = m_trouble;
  if (m_tool.active() && !m_path->problem().isEmpty())
    mode = m_path->problem();
  else if (m_tool.active() && m_path->points().empty())
    mode = tr("The document has no path to edit. Add one in the Path panel.");
  else if (m_tool.active())
    mode =
        tr("Drag a way-point to move it, double-click the floor to add one, Delete removes the "
           "chosen one.");
  m_overlay->setMode(mode);
}

void SceneView::setSettings(const SceneSettings& settings) {
  const bool moved = settings.placement != m_settings.placement;
  m_settings = settings;
  if (settings.colourBy == ColourBy::Likelihood) scoreNatural();
  changeMotions();
  if (moved) {
    flush();
    fit();
  }
}

void SceneView::setView(render::View view) {
  m_cameraMoved = true;
  m_scene.setView(view, width(), height());
  schedule();
}

void SceneView::fit() {
  if (m_content.motions.empty() && m_path->frames().empty()) return;
  m_scene.fit(width(), height());
  schedule();
}

CameraPose SceneView::camera() const {
  const render::Camera c = m_scene.camera();
  const auto point = [](const Vec3& v) { return std::array<double, 3>{v.x(), v.y(), v.z()}; };
  return {point(c.eye), point(c.target), point(c.up), c.heightM, c.orthographic};
}

void SceneView::setCamera(const CameraPose& pose) {
  const auto point = [](const std::array<double, 3>& v) {
    return Vec3(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
  };
  render::Viewpoint viewpoint = m_scene.viewpoint();
  viewpoint.camera.eye = point(pose.eye);
  viewpoint.camera.target = point(pose.target);
  viewpoint.camera.up = point(pose.up);
  viewpoint.camera.heightM = pose.heightM;
  viewpoint.camera.orthographic = pose.orthographic;
  m_cameraKept = true;
  m_scene.setViewpoint(viewpoint);
  schedule();
}

void SceneView::releaseCamera() {
  m_cameraKept = m_cameraMoved = false;
  m_fittedMotions = 0;
}

void SceneView::setFollow(bool follow) {
  m_scene.setFollow(follow);
  schedule();
}

void SceneView::setOrthographic(bool orthographic) {
  m_scene.setOrthographic(orthographic);
  schedule();
}

void SceneView::setPathEditing(bool editing) {
  m_tool.setActive(editing);
  changeOptions();
}

void SceneView::removeWayPoint() {
  m_tool.removeChosen();
  schedule();
}

/// Samples carry their scores; natural motion gets those under the chosen model.
void SceneView::scoreNatural() {
  const auto& groups = m_workspace.motions().groups();
  const bool natural = std::any_of(groups.begin(), groups.end(), [](const MotionGroup& g) {
    return g.natural() && !g.motions.empty();
  });
  const std::string system = naturalSystem(m_workspace, m_settings);
  if (natural && !system.empty() && !m_workspace.natural().scores(system))
    m_workspace.natural().score(system);
}

}  // namespace marey::gui
