#include "gui/shell/job_list.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QToolButton>
#include <QVBoxLayout>
#include <cmath>
#include <set>

namespace marey::gui {
namespace {

QString stateText(const JobStatus& job) {
  if (job.waiting) return JobList::tr("waiting");
  QStringList parts;
  if (!job.message.isEmpty()) parts += job.message;
  parts += JobList::tr("%1 %").arg(static_cast<int>(100.0 * job.fraction));
  if (job.seconds > 0.5 && job.fraction > 0.0)
    parts += JobList::tr("%1 % per minute").arg(6000.0 * job.fraction / job.seconds, 0, 'g', 2);
  const QString left = timeLeftText(job);
  if (!left.isEmpty()) parts += left;
  return parts.join(QStringLiteral(" · "));
}

}  // namespace

QString timeLeftText(const JobStatus& job) {
  if (job.secondsLeft < 0.0) return {};
  const int whole = static_cast<int>(std::ceil(job.secondsLeft));
  if (whole < 60) return JobList::tr("%1 s left").arg(whole);
  return JobList::tr("%1:%2 left").arg(whole / 60).arg(whole % 60, 2, 10, QLatin1Char('0'));
}

JobList::JobList(JobQueue& jobs, QWidget* parent) : QFrame(parent, Qt::Popup), m_jobs(jobs) {
  setObjectName(QStringLiteral("jobList"));
  setFrameShape(QFrame::StyledPanel);
  setAttribute(Qt::WA_DeleteOnClose);
  m_layout = new QVBoxLayout(this);
  connect(&m_jobs, &JobQueue::changed, this, &JobList::refresh);
  refresh();
}

JobList::Row JobList::makeRow(const JobStatus& job) {
  Row row{.widget = new QWidget(this), .text = new QLabel(this), .bar = new QProgressBar(this)};
  row.bar->setFixedSize(120, 14);
  row.bar->setRange(0, 1000);
  row.bar->setTextVisible(false);
  row.text->setMinimumWidth(300);
  auto* cancel = new QToolButton(this);
  cancel->setObjectName(QStringLiteral("cancelJob%1").arg(job.id));
  cancel->setText(tr("Cancel"));
  connect(cancel, &QToolButton::clicked, this, [this, id = job.id] { m_jobs.cancel(id); });
  auto* layout = new QHBoxLayout(row.widget);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(row.text, 1);
  layout->addWidget(row.bar);
  layout->addWidget(cancel);
  m_layout->addWidget(row.widget);
  return row;
}

void JobList::refresh() {
  std::set<int> present;
  for (const JobStatus& job : m_jobs.jobs()) {
    present.insert(job.id);
    auto found = m_rows.find(job.id);
    if (found == m_rows.end()) found = m_rows.emplace(job.id, makeRow(job)).first;
    found->second.text->setText(
        QStringLiteral("<b>%1</b><br>%2")
            .arg(job.title.toHtmlEscaped(), stateText(job).toHtmlEscaped()));
    found->second.bar->setValue(static_cast<int>(1000.0 * job.fraction));
  }
  std::erase_if(m_rows, [&](const auto& entry) {
    if (present.contains(entry.first)) return false;
    // Its own button may be what ended it.
    entry.second.widget->hide();
    entry.second.widget->deleteLater();
    return true;
  });
  if (present.empty()) close();
  adjustSize();
}

}  // namespace marey::gui
