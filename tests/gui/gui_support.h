// A window with the demonstration in it, and ways to wait for it as a person would.
#pragma once

#include <QTemporaryDir>
#include <filesystem>
#include <functional>
#include <memory>

#include "gui/shell/main_window.h"
#include "gui/shell/panels.h"
#include <gtest/gtest.h>

#include "render/base/image.h"

namespace marey::gui {

/// Runs the event loop until `ready`; false after `seconds`.
bool waitUntil(const std::function<bool()>& ready, double seconds = 240.0);
/// Runs the event loop for a while.
void settle(int milliseconds = 200);
render::Image pictureOf(QWidget& widget);
/// Whether a picture shows more than one flat colour.
bool showsSomething(const render::Image& image);
/// Compares with tests/gui/baselines/NAME.png; a missing baseline fails and saves the picture.
void expectLikeBaseline(const render::Image& image, const std::string& name, double leastSsim);

/// A child by type and name; ends the test where there is none. A panel has to be shown first:
/// docks keep the hidden ones aside.
template <typename T>
T* child(QWidget& widget, const char* name) {
  T* found = widget.findChild<T*>(QString::fromLatin1(name));
  if (found == nullptr) throw std::runtime_error(std::string("no widget '") + name + "'");
  return found;
}

class WindowTest : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;
  /// The demonstration with two samples of two seconds, its natural clips read.
  void openSmallDemo();
  /// Shows the window as the user has it before; makes a new one where there is one.
  void openWindow();
  /// Waits until no job runs.
  bool idle();
  /// In the test's own folder.
  std::filesystem::path file(const std::string& name) const;

  QTemporaryDir m_folder;
  std::unique_ptr<JobQueue> m_jobs;
  std::unique_ptr<Workspace> m_workspace;
  std::unique_ptr<MainWindow> m_window;
  std::vector<std::string> m_errors;  ///< reported to the user
};

/// Starts with the small demonstration in an open window.
class DemoTest : public WindowTest {
 protected:
  void SetUp() override;
};

/// Forty frames of a body of two joints, which no model has.
void writeSmallBvh(const std::filesystem::path& path);

}  // namespace marey::gui
