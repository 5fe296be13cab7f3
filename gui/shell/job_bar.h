// The status bar's right end: what runs, how far it is, how long it still takes, and buttons that
// list the jobs and stop them.
#pragma once

#include <QWidget>

#include "gui/common/jobs.h"

class QLabel;
class QProgressBar;
class QToolButton;

namespace marey::gui {

class JobBar : public QWidget {
  Q_OBJECT
 public:
  JobBar(JobQueue& jobs, QWidget* parent);

 private:
  void refresh();
  void showList();

  JobQueue& m_jobs;
  QLabel* m_text;
  QProgressBar* m_bar;
  QToolButton* m_list;
  QToolButton* m_cancel;
};

}  // namespace marey::gui
