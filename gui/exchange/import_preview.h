// One clip of a motion file from the front and from the side, with a scrubber.
#pragma once

#include <QSlider>
#include <QWidget>
#include <memory>

#include "gui/common/jobs.h"
#include "gui/common/stick_view.h"

#include "io/format.h"

namespace marey::gui {

class ImportPreview : public QWidget {
 public:
  ImportPreview(JobQueue& jobs, QWidget* parent);
  /// Ends its reading.
  ~ImportPreview() override;
  /// Reads the file in the background and shows its clip of that number.
  void show(const std::string& path, size_t number, const io::ReadOptions& options);

 private:
  void showClip(std::shared_ptr<const Clip> clip);
  void showFrame();

  JobQueue& m_jobs;
  StickView* m_front;
  StickView* m_side;
  QSlider* m_scrub;
  std::shared_ptr<const Clip> m_clip;
  int m_version = 0;  ///< counts readings, so that a late one is not taken
  int m_job = -1;
};

}  // namespace marey::gui
