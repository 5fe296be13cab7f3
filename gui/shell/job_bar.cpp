#include "shell/job_bar.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QToolButton>
#include <cmath>

namespace marey::gui {
namespace {

QString timeLeft(double seconds) {
  const int whole = static_cast<int>(std::ceil(seconds));
  if (whole < 60) return JobBar::tr("%1 s left").arg(whole);
  return JobBar::tr("%1:%2 left").arg(whole / 60).arg(whole % 60, 2, 10, QLatin1Char('0'));
}

}  // namespace

JobBar::JobBar(JobQueue& jobs, QWidget* parent) : QWidget(parent), m_jobs(jobs) {
  setObjectName(QStringLiteral("jobBar"));
  m_text = new QLabel(this);
  m_bar = new QProgressBar(this);
  m_bar->setFixedSize(150, 16);
  m_bar->setRange(0, 1000);
  m_bar->setTextVisible(false);
  m_cancel = new QToolButton(this);
  m_cancel->setObjectName(QStringLiteral("cancelJobs"));
  m_cancel->setText(tr("Cancel"));
  m_cancel->setToolTip(tr("Stop all background work; what is finished stays (Esc)"));
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 6, 0);
  layout->addWidget(m_text);
  layout->addWidget(m_bar);
  layout->addWidget(m_cancel);
  connect(m_cancel, &QToolButton::clicked, &m_jobs, &JobQueue::cancelAll);
  connect(&m_jobs, &JobQueue::changed, this, &JobBar::refresh);
  refresh();
}

void JobBar::refresh() {
  const auto jobs = m_jobs.jobs();
  m_bar->setVisible(!jobs.empty());
  m_cancel->setVisible(!jobs.empty());
  m_text->setVisible(!jobs.empty());
  if (jobs.empty()) return;
  const JobStatus& first = jobs.front();
  QString text = first.title;
  if (first.secondsLeft >= 0.0) text += QStringLiteral(" · ") + timeLeft(first.secondsLeft);
  if (jobs.size() > 1) text += tr(" · %1 more").arg(jobs.size() - 1);
  m_text->setText(text);
  m_bar->setValue(static_cast<int>(1000.0 * first.fraction));
}

}  // namespace marey::gui
