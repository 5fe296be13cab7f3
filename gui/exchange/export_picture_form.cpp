#include "gui/exchange/export_picture_form.h"

#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <algorithm>
#include <set>
#include <utility>

#include "gui/common/number_box.h"
#include "gui/scene/scene_legend.h"

namespace marey::gui {
namespace {

constexpr double kMostGifFps = 50.0, kMostFps = 240.0;
constexpr int kLeastPixels = 64, kMostPixels = 8192;
constexpr int kAsSeen = -1;  ///< in place of a preset of the camera

const char* nameOf(ColourBy colours) {
  switch (colours) {
    case ColourBy::System:
      return "system";
    case ColourBy::Sample:
      return "sample";
    case ColourBy::Likelihood:
      return "log-likelihood";
    case ColourBy::Speed:
      break;
  }
  return "speed";
}

}  // namespace

ExportPictureForm::ExportPictureForm(std::shared_ptr<const ShownScene> scene, QWidget* parent)
    : QGroupBox(tr("Picture"), parent),
      m_scene(std::move(scene)),
      m_look(new QComboBox(this)),
      m_width(pixels("exportWidth", 1280)),
      m_height(pixels("exportHeight", 720)),
      m_fps(new NumberBox(this)),
      m_view(new QComboBox(this)),
      m_orthographic(new QCheckBox(tr("Orthographic"), this)),
      m_camera(new QComboBox(this)),
      m_dark(new QCheckBox(tr("Dark background"), this)),
      m_legend(new QCheckBox(tr("Legend"), this)),
      m_trail(new QCheckBox(tr("Earlier figures stay, lighter"), this)),
      m_strobe(new NumberBox(this)),
      m_path(new QCheckBox(tr("Path that was asked for"), this)) {
  const std::pair<QWidget*, const char*> names[] = {
      {m_look, "exportLook"},     {m_fps, "exportFps"},
      {m_view, "exportView"},     {m_orthographic, "exportOrthographic"},
      {m_camera, "exportCamera"}, {m_dark, "exportDark"},
      {m_legend, "exportLegend"}, {m_trail, "exportTrail"},
      {m_strobe, "exportStrobe"}, {m_path, "exportPath"}};
  for (const auto& [widget, name] : names) widget->setObjectName(QLatin1String(name));
  if (m_scene) m_look->addItem(tr("As in the 3D view"), true);
  m_look->addItem(tr("Figure with exposures, as marey render draws it"), false);
  m_fps->setRange(1.0, kMostFps);
  m_fps->setDecimals(1);
  m_fps->setValue(30.0);
  m_camera->addItems({tr("Fixed"), tr("Following the figures")});
  if (m_scene) {
    m_camera->setCurrentIndex(m_scene->follow ? 1 : 0);
    m_dark->setChecked(m_scene->options.tone == render::Tone::Dark);
  }
  m_legend->setChecked(true);
  m_strobe->setRange(0.05, 60.0);
  m_strobe->setSingleStep(0.1);
  m_strobe->setValue(0.4);
  m_strobe->setPrefix(tr("a figure every "));
  m_strobe->setSuffix(tr(" s"));
  m_path->setChecked(true);
  auto* form = new QFormLayout(this);
  form->addRow(tr("Drawn"), m_look);
  form->addRow(tr("Size in pixels"), sizeRow());
  form->addRow(tr("Frames per second"), m_fps);
  form->addRow(tr("View"), m_view);
  form->addRow({}, m_orthographic);
  form->addRow(tr("Camera"), m_camera);
  form->addRow({}, m_dark);
  form->addRow({}, m_legend);
  form->addRow(tr("Trail"), m_trail);
  form->addRow(tr("Exposures"), m_strobe);
  form->addRow(tr("On the floor"), m_path);
  connect(m_look, qOverload<int>(&QComboBox::currentIndexChanged), this, [this] {
    addViews();
    refresh();
  });
  connect(m_view, qOverload<int>(&QComboBox::currentIndexChanged), this,
          &ExportPictureForm::refresh);
  connect(m_trail, &QCheckBox::toggled, this, &ExportPictureForm::refresh);
  addViews();
  refresh();
}

QSpinBox* ExportPictureForm::pixels(const char* name, int value) {
  auto* box = new CountBox(this);
  box->setObjectName(QLatin1String(name));
  box->setRange(kLeastPixels, kMostPixels);
  box->setSingleStep(2);
  box->setValue(value);
  return box;
}

QWidget* ExportPictureForm::sizeRow() {
  auto* row = new QWidget(this);
  auto* layout = new QHBoxLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(m_width);
  layout->addWidget(new QLabel(QStringLiteral("×"), row));
  layout->addWidget(m_height);
  layout->addStretch(1);
  return row;
}

bool ExportPictureForm::asInView() const {
  return m_scene && m_look->currentData().toBool();
}

void ExportPictureForm::addViews() {
  m_view->clear();
  const auto add = [this](const QString& text, auto view) {
    m_view->addItem(text, static_cast<int>(view));
  };
  if (!asInView()) {
    add(tr("From the side and above"), render::View::ThreeQuarter);
    add(tr("From the side"), render::View::Side);
    add(tr("From above"), render::View::Top);
    return;
  }
  add(tr("As it is seen now"), kAsSeen);
  add(tr("From the side and above"), render::View::ThreeQuarter);
  add(tr("From the side"), render::View::Side);
  add(tr("From the front"), render::View::Front);
  add(tr("From behind"), render::View::Back);
  add(tr("From above"), render::View::Top);
}

void ExportPictureForm::setFormat(ExportFormat format) {
  m_format = format;
  m_fps->setMaximum(format == ExportFormat::Gif ? kMostGifFps : kMostFps);
  refresh();
}

void ExportPictureForm::refresh() {
  const bool video = isVideo(m_format), live = asInView();
  m_fps->setEnabled(video);
  m_camera->setEnabled(video);
  // The view that is seen has its own projection.
  m_orthographic->setEnabled(!live || m_view->currentData().toInt() != kAsSeen);
  m_dark->setEnabled(live);
  m_legend->setEnabled(live);
  m_trail->setEnabled(!live && video);
  m_strobe->setEnabled(!live && (!video || m_trail->isChecked()));
  m_path->setEnabled(!live);
}

void ExportPictureForm::fill(ExportRequest& request, bool apart) const {
  request.width = m_width->value();
  request.height = m_height->value();
  // The encoders of videos halve the colours' resolution.
  if (request.format == ExportFormat::Mp4 || request.format == ExportFormat::WebM) {
    request.width -= request.width % 2;
    request.height -= request.height % 2;
  }
  request.fps = m_fps->value();
  request.follow = isVideo(m_format) && m_camera->currentIndex() == 1;
  request.orthographic = m_orthographic->isChecked();
  if (asInView()) return fillShot(request, apart);
  request.view = static_cast<render::View>(m_view->currentData().toInt());
  request.trail = m_trail->isChecked();
  request.path = m_path->isChecked();
  request.strobeS = m_strobe->value();
}

void ExportPictureForm::fillShot(ExportRequest& request, bool apart) const {
  copyScene(*m_scene, request, apart);
  render::Shot& shot = *request.shot;
  shot.options.tone = m_dark->isChecked() ? render::Tone::Dark : render::Tone::Light;
  if (const int view = m_view->currentData().toInt(); view != kAsSeen)
    shot.view = static_cast<render::View>(view);
  shot.orthographic = request.orthographic;
  shot.follow = request.follow;
  if (m_legend->isChecked()) addLegend(*m_scene, request);
}

void copyScene(const ShownScene& scene, ExportRequest& request, bool apart) {
  std::set<const Clip*> wanted, shown;
  for (const ExportItem& item : request.items) wanted.insert(item.clip.get());
  render::Shot shot;
  for (render::SceneMotion motion : scene.motions) {
    if (!wanted.contains(motion.clip.get())) continue;
    shown.insert(motion.clip.get());
    if (apart) motion.highlighted = false;
    shot.motions.push_back(std::move(motion));
  }
  std::erase_if(request.items,
                [&](const ExportItem& item) { return !shown.contains(item.clip.get()); });
  shot.options = scene.options;
  shot.viewpoint = scene.viewpoint;
  if (request.range) {
    shot.beginS = request.range->beginS;
    shot.endS = request.range->endS;
  }
  request.stillS = scene.timeS;
  request.shotSettings = {{"colour_by", nameOf(scene.colourBy)}};
  request.shot = std::move(shot);
}

void addLegend(const ShownScene& scene, ExportRequest& request) {
  SceneLegend legend = scene.legend;
  legend.groups.clear();
  std::vector<int> counts;
  std::vector<const ExportItem*> firsts;
  for (const ExportItem& item : request.items) {
    const auto known = std::find_if(firsts.begin(), firsts.end(),
                                    [&](const auto* f) { return f->group == item.group; });
    const auto index = static_cast<size_t>(known - firsts.begin());
    if (known == firsts.end()) {
      firsts.push_back(&item);
      counts.push_back(0);
    }
    ++counts[index];
  }
  for (size_t i = 0; i < firsts.size(); ++i)
    legend.groups.push_back({firsts[i]->colour, groupLabel(firsts[i]->group, counts[i])});
  request.shotSettings["legend"] = true;
  request.shot->over = legendPicture(legend, request.width, request.height,
                                     request.shot->options.tone == render::Tone::Dark);
}

}  // namespace marey::gui
