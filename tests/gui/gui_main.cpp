// Tests of a real window. Listing them needs no display.
#include <cstring>

#include "panels/scene_view.h"
#include "shell/application.h"
#include <gtest/gtest.h>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (::testing::GTEST_FLAG(list_tests)) return RUN_ALL_TESTS();
  marey::gui::SceneView::prepareApplication();
  marey::gui::Application application(argc, argv);
  QApplication::setOrganizationName(QStringLiteral("Marey"));
  QApplication::setApplicationName(QStringLiteral("Marey"));
  return RUN_ALL_TESTS();
}
