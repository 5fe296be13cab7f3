// How pictures and videos of motions are drawn: the part of the export dialog that only they need.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QGroupBox>
#include <QSpinBox>
#include <memory>

#include "gui/scene/shown_scene.h"

#include "report/motion_export.h"

namespace marey::gui {

/// Copies what a view shows now into a request, whose items become those that are shown.
/// `apart`: the motions are no part of what else is shown, so none of them stands out.
void copyScene(const ShownScene& scene, ExportRequest& request, bool apart);
/// Lays the view's legend, with the request's motions, over the request's pictures.
void addLegend(const ShownScene& scene, ExportRequest& request);

class ExportPictureForm : public QGroupBox {
 public:
  /// `scene` is what the 3D view shows; without it only figures can be drawn.
  ExportPictureForm(std::shared_ptr<const ShownScene> scene, QWidget* parent);
  /// Greys out what a format does not use.
  void setFormat(ExportFormat format);
  /// Size, rate and look; with that of the 3D view as copyScene does.
  void fill(ExportRequest& request, bool apart) const;

 private:
  QSpinBox* pixels(const char* name, int value);
  QWidget* sizeRow();
  void addViews();
  void refresh();
  bool asInView() const;
  void fillShot(ExportRequest& request, bool apart) const;

  std::shared_ptr<const ShownScene> m_scene;
  ExportFormat m_format = ExportFormat::Mp4;
  QComboBox* m_look;
  QSpinBox* m_width;
  QSpinBox* m_height;
  QDoubleSpinBox* m_fps;
  QComboBox* m_view;
  QCheckBox* m_orthographic;
  QComboBox* m_camera;
  QCheckBox* m_dark;
  QCheckBox* m_legend;
  QCheckBox* m_trail;
  QDoubleSpinBox* m_strobe;
  QCheckBox* m_path;
};

}  // namespace marey::gui
