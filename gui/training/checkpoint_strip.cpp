#include "gui/training/checkpoint_strip.h"

#include <QPainter>
#include <algorithm>
#include <filesystem>

#include "gui/common/paint_style.h"

#include "base/error.h"
#include "render/scene/shot.h"

namespace marey::gui {
namespace {

constexpr int kWidth = 132, kHeight = 84;
/// Figures of a picture: enough to see the gait, few enough to see each.
constexpr double kFigures = 7.0, kShortestStrobeS = 0.3;

struct Wanted {
  std::string file;
  ClipPtr clip;
  std::vector<RootFrame> path;
  render::Colour colour;
};

QImage pictureOf(const Wanted& wanted) {
  const double seconds = (wanted.clip->frameCount() - 1) / wanted.clip->fps;
  render::Shot shot =
      render::strobed(render::printed({{.clip = wanted.clip, .colour = wanted.colour}}),
                      std::max(kShortestStrobeS, seconds / kFigures));
  shot.options.path = wanted.path;
  shot.caption = {};
  // Twice as large, so that limbs stay smooth lines when it is made small.
  const render::Image image = render::drawEnd(shot, 2 * kWidth, 2 * kHeight);
  const QImage view(image.pixels.data(), image.width, image.height, QImage::Format_RGBA8888);
  return view.scaled(kWidth, kHeight, Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
}

/// In place of a picture, the colour that its motions will have.
QPixmap emptyPicture(const QColor& colour, const QColor& background) {
  QPixmap out(kWidth, kHeight);
  out.fill(background);
  QPainter painter(&out);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  painter.setBrush(colour);
  painter.drawEllipse(QPointF(kWidth / 2.0, kHeight / 2.0), 8, 8);
  return out;
}

}  // namespace

CheckpointStrip::CheckpointStrip(Workspace& workspace, QWidget* parent)
    : QListWidget(parent), m_workspace(workspace) {
  setAccessibleName(tr("Pictures of the checkpoints' first samples"));
  setToolTip(
      tr("The first sample of each checkpoint along the current path; click to select its "
         "motions"));
  setViewMode(QListView::IconMode);
  setFlow(QListView::LeftToRight);
  setMovement(QListView::Static);
  setResizeMode(QListView::Adjust);
  setIconSize(QSize(kWidth, kHeight));
  setMinimumWidth(kWidth + 40);
  connect(this, &QListWidget::itemClicked, this,
          [this](const QListWidgetItem* item) { choose(row(item)); });
  connect(&workspace.motions(), &MotionGroups::changed, this, &CheckpointStrip::refresh);
  for (const auto changed : {&Document::currentPathChanged, &Document::changed})
    connect(&workspace.document(), changed, this, &CheckpointStrip::refresh);
  connect(&workspace.jobs(), &JobQueue::ended, this, [this](int job) {
    if (job != m_job) return;
    m_job = -1;
    refresh();
  });
}

void CheckpointStrip::setRun(const TrainingRun& run) {
  m_run = run;
  const int chosen = currentRow();
  clear();
  for (const Checkpoint& checkpoint : m_run.checkpoints)
    addItem(QString::fromStdString(checkpoint.name));
  setCurrentRow(std::min(chosen, count() - 1));
  refresh();
}

void CheckpointStrip::showEvent(QShowEvent* event) {
  QListWidget::showEvent(event);
  refresh();
}

const MotionGroup* CheckpointStrip::motionsOf(const Checkpoint& checkpoint) const {
  const Experiment& e = m_workspace.document().experiment();
  if (e.paths.empty()) return nullptr;
  const std::string& path = e.paths[static_cast<size_t>(m_workspace.document().currentPath())].name;
  const std::string model = std::filesystem::absolute(checkpoint.file).string();
  const MotionGroup* newest = nullptr;
  for (const MotionGroup& group : m_workspace.motions().groups())
    if (group.recipe && group.recipe->system.model == model && group.recipe->path.name == path &&
        !group.motions.empty())
      newest = &group;
  return newest;
}

bool CheckpointStrip::current(const Checkpoint& checkpoint) const {
  const MotionGroup* group = motionsOf(checkpoint);
  const auto known = m_pictures.find(checkpoint.file);
  return group != nullptr && known != m_pictures.end() &&
         known->second.clip == group->motions.front().clip &&
         known->second.colour == render::colourOf(group->colourIndex);
}

bool CheckpointStrip::drawn(int checkpoint) const {
  const Checkpoint& of = m_run.checkpoints.at(static_cast<size_t>(checkpoint));
  return current(of) && !m_pictures.at(of.file).image.isNull();
}

void CheckpointStrip::refresh() {
  // Nothing is drawn for a panel that is not seen; showing it comes back here.
  if (!isVisible()) return;
  for (int i = 0; i < count(); ++i) {
    const Checkpoint& checkpoint = m_run.checkpoints[static_cast<size_t>(i)];
    const QColor colour =
        toQColor(render::colourOf(render::stageIndex(stageOf(m_run, checkpoint))));
    const QPixmap picture = drawn(i)
                                ? QPixmap::fromImage(m_pictures.at(checkpoint.file).image)
                                : emptyPicture(colour, palette().color(QPalette::AlternateBase));
    item(i)->setIcon(QIcon(picture));
  }
  drawMissing();
}

void CheckpointStrip::drawMissing() {
  if (m_job >= 0) return;
  std::vector<Wanted> missing;
  for (const Checkpoint& checkpoint : m_run.checkpoints) {
    const MotionGroup* group = motionsOf(checkpoint);
    if (group == nullptr || current(checkpoint)) continue;
    missing.push_back({checkpoint.file, group->motions.front().clip, group->wanted,
                       render::colourOf(group->colourIndex)});
    // One that cannot be drawn is not tried again.
    m_pictures[checkpoint.file] = {missing.back().clip, missing.back().colour, {}};
  }
  if (missing.empty()) return;
  const auto images = std::make_shared<std::vector<QImage>>();
  const auto work = [missing, images](Progress& progress) {
    for (size_t i = 0; i < missing.size(); ++i) {
      progress.throwIfCancelled();
      progress.report(static_cast<double>(i) / static_cast<double>(missing.size()));
      images->push_back(pictureOf(missing[i]));
    }
  };
  const auto take = [this, missing, images] {
    for (size_t i = 0; i < images->size(); ++i)
      m_pictures[missing[i].file] = {missing[i].clip, missing[i].colour, (*images)[i]};
  };
  m_job =
      m_workspace.jobs().start(Lane::Files, tr("Draw pictures of checkpoints"), work, take, this);
}

void CheckpointStrip::choose(int index) {
  if (index < 0) return;
  if (const MotionGroup* group = motionsOf(m_run.checkpoints[static_cast<size_t>(index)])) {
    Selection next{.motions = {}, .joint = m_workspace.view().selection().joint};
    for (size_t i = 0; i < group->motions.size(); ++i)
      next.motions.insert({group->id, static_cast<int>(i)});
    m_workspace.view().select(std::move(next));
  }
  Q_EMIT checkpointClicked(index);
}

}  // namespace marey::gui
