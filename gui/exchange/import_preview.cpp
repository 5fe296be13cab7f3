#include "gui/exchange/import_preview.h"

#include <QPointer>
#include <QVBoxLayout>
#include <numbers>

#include "base/error.h"
#include "io/clip_io.h"

namespace marey::gui {

ImportPreview::ImportPreview(JobQueue& jobs, QWidget* parent)
    : QWidget(parent),
      m_jobs(jobs),
      m_front(new StickView(this)),
      m_side(new StickView(this)),
      m_scrub(new QSlider(Qt::Horizontal, this)) {
  m_front->setObjectName(QStringLiteral("importFront"));
  m_front->setTitle(tr("Front (left blue, right orange)"));
  m_side->setObjectName(QStringLiteral("importSide"));
  m_side->setTitle(tr("Side"));
  m_scrub->setObjectName(QStringLiteral("importScrub"));
  m_scrub->setAccessibleName(tr("Frame of the preview"));
  connect(m_scrub, &QSlider::valueChanged, this, &ImportPreview::showFrame);
  auto* views = new QHBoxLayout;
  views->addWidget(m_front);
  views->addWidget(m_side);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addLayout(views, 1);
  layout->addWidget(m_scrub);
}

ImportPreview::~ImportPreview() {
  m_jobs.cancel(m_job);
}

void ImportPreview::show(const std::string& path, size_t number, const io::ReadOptions& options) {
  auto clip = std::make_shared<std::shared_ptr<const Clip>>();
  const int version = ++m_version;
  const QPointer<ImportPreview> self(this);
  m_jobs.cancel(m_job);
  m_job = m_jobs.start(
      Lane::Previews, tr("Reading a preview"),
      [clip, number, path, options](Progress&) {
        try {
          std::vector<Clip> clips = io::readClips(path, options);
          if (number < clips.size()) *clip = std::make_shared<const Clip>(std::move(clips[number]));
        } catch (const Error&) {  // the table of findings tells what is wrong with it
        }
      },
      [self, clip, version] {
        if (self && self->m_version == version) self->showClip(*clip);
      });
}

void ImportPreview::showClip(std::shared_ptr<const Clip> clip) {
  m_clip = std::move(clip);
  const double heading = m_clip ? firstHeading(*m_clip) : 0.0;
  constexpr double kElevation = 0.12;  // a little from above, so that the floor can be seen
  m_front->setDirection(heading, kElevation);
  m_side->setDirection(heading - std::numbers::pi / 2, kElevation);
  m_scrub->setRange(0, m_clip ? m_clip->frameCount() - 1 : 0);
  showFrame();
}

void ImportPreview::showFrame() {
  std::vector<StickFigure> figures;
  if (m_clip) {
    const auto frame = m_clip->frame(std::min(m_scrub->value(), m_clip->frameCount() - 1));
    figures.push_back({m_clip->skeleton, {frame.begin(), frame.end()}, {}});
  }
  for (StickView* view : {m_front, m_side}) {
    view->setHint(tr("This file cannot be shown."));
    view->setFigures(figures);
  }
}

}  // namespace marey::gui
