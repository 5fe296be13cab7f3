// Tests of a real window. Listing them needs no display.
#include <QSurfaceFormat>
#include <cstring>

#include "shell/application.h"
#include <QVTKOpenGLNativeWidget.h>
#include <gtest/gtest.h>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (::testing::GTEST_FLAG(list_tests)) return RUN_ALL_TESTS();
  QSurfaceFormat format = QVTKOpenGLNativeWidget::defaultFormat();
  format.setSamples(0);
  QSurfaceFormat::setDefaultFormat(format);
  marey::gui::Application application(argc, argv);
  QApplication::setOrganizationName(QStringLiteral("Marey"));
  QApplication::setApplicationName(QStringLiteral("Marey"));
  return RUN_ALL_TESTS();
}
