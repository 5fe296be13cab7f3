#include "gui/shell/job_bar.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QToolButton>

#include "gui/shell/job_list.h"

namespace marey::gui {

JobBar::JobBar(JobQueue& jobs, QWidget* parent) : QWidget(parent), m_jobs(jobs) {
  setObjectName(QStringLiteral("jobBar"));
  m_text = new QLabel(this);
  m_bar = new QProgressBar(this);
  m_bar->setFixedSize(150, 16);
  m_bar->setRange(0, 1000);
  m_bar->setTextVisible(false);
  m_list = new QToolButton(this);
  m_list->setObjectName(QStringLiteral("listJobs"));
  m_list->setText(tr("Jobs…"));
  m_list->setToolTip(tr("All background work, to stop one job alone"));
  m_cancel = new QToolButton(this);
  m_cancel->setObjectName(QStringLiteral("cancelJobs"));
  m_cancel->setText(tr("Cancel"));
  m_cancel->setToolTip(tr("Stop all background work, exports too; what is finished stays"));
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 6, 0);
  for (QWidget* part : {static_cast<QWidget*>(m_text), static_cast<QWidget*>(m_bar),
                        static_cast<QWidget*>(m_list), static_cast<QWidget*>(m_cancel)})
    layout->addWidget(part);
  connect(m_cancel, &QToolButton::clicked, &m_jobs, &JobQueue::cancelAll);
  connect(m_list, &QToolButton::clicked, this, &JobBar::showList);
  connect(&m_jobs, &JobQueue::changed, this, &JobBar::refresh);
  refresh();
}

void JobBar::refresh() {
  const auto jobs = m_jobs.jobs();
  for (QWidget* part : {static_cast<QWidget*>(m_text), static_cast<QWidget*>(m_bar),
                        static_cast<QWidget*>(m_list), static_cast<QWidget*>(m_cancel)})
    part->setVisible(!jobs.empty());
  if (jobs.empty()) return;
  const JobStatus& first = jobs.front();
  QString text = first.title;
  const QString left = timeLeftText(first);
  if (!left.isEmpty()) text += QStringLiteral(" · ") + left;
  if (jobs.size() > 1) text += tr(" · %1 more").arg(jobs.size() - 1);
  m_text->setText(text);
  m_bar->setValue(static_cast<int>(1000.0 * first.fraction));
}

void JobBar::showList() {
  auto* list = new JobList(m_jobs, this);
  list->move(mapToGlobal(QPoint(width() - list->width(), -list->height())));
  list->show();
}

}  // namespace marey::gui
