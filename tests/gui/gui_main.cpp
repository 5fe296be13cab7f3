// Tests of a real window. Listing them needs no display.
#include <QTemporaryDir>

#include "gui/scene/scene_view.h"
#include "gui/shell/application.h"
#include <gtest/gtest.h>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (::testing::GTEST_FLAG(list_tests)) return RUN_ALL_TESTS();
  // Qt writes settings after the last test, into the folder that the test had: all of them lie in
  // one that goes last.
  const QTemporaryDir folder;
  qputenv("TMPDIR", folder.path().toUtf8());
  marey::gui::SceneView::prepareApplication();
  marey::gui::Application application(argc, argv);
  QApplication::setOrganizationName(QStringLiteral("Marey"));
  QApplication::setApplicationName(QStringLiteral("Marey"));
  return RUN_ALL_TESTS();
}
