// Every job of the window with its progress and a button that stops it alone.
#pragma once

#include <QFrame>
#include <map>

#include "gui/common/jobs.h"

class QLabel;
class QProgressBar;
class QToolButton;
class QVBoxLayout;

namespace marey::gui {

/// "34 s left"; empty while unknown.
QString timeLeftText(const JobStatus& job);

/// A popup; it goes when there is no job left.
class JobList : public QFrame {
  Q_OBJECT
 public:
  JobList(JobQueue& jobs, QWidget* parent);

 private:
  struct Row {
    QWidget* widget = nullptr;
    QLabel* text = nullptr;
    QProgressBar* bar = nullptr;
  };
  void refresh();
  Row makeRow(const JobStatus& job);

  JobQueue& m_jobs;
  QVBoxLayout* m_layout;
  std::map<int, Row> m_rows;  ///< by job
};

}  // namespace marey::gui
