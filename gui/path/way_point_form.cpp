#include "gui/path/way_point_form.h"

#include <QGridLayout>
#include <QHBoxLayout>
#include <cmath>
#include <numbers>

#include "gui/common/number_box.h"

namespace marey::gui {
namespace {
constexpr double kDegrees = 180.0 / std::numbers::pi;
}  // namespace

WayPointForm::WayPointForm(CurrentPath& path, PathView& view, QWidget* parent)
    : QWidget(parent), m_path(path), m_view(view) {
  setObjectName(QStringLiteral("wayPointForm"));
  build();
  connectEdits();
  connect(&path, &CurrentPath::changed, this, &WayPointForm::refresh);
  connect(&view, &PathView::chosenChanged, this, &WayPointForm::refresh);
  refresh();
}

NumberBox* WayPointForm::number(const char* name, const QString& suffix, double low, double high,
                                double step, const QString& toolTip) {
  auto* box = new NumberBox(this);
  box->setObjectName(QLatin1String(name));
  box->setRange(low, high);
  box->setDecimals(2);
  box->setSingleStep(step);
  box->setSuffix(suffix);
  box->setToolTip(toolTip);
  box->setAccessibleName(toolTip);
  return box;
}

void WayPointForm::build() {
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setHorizontalSpacing(kSpacing);
  grid->setVerticalSpacing(4);
  m_index = new CountBox(this);
  m_index->setObjectName(QStringLiteral("wayPointIndex"));
  m_index->setSpecialValueText(tr("none"));
  m_index->setToolTip(tr("The way-point whose numbers are shown"));
  m_count = new QLabel(this);
  m_remove = new QPushButton(tr("Remove"), this);
  m_remove->setObjectName(QStringLiteral("wayPointRemove"));
  m_remove->setToolTip(tr("Remove this way-point (Delete); two are always left"));
  auto* first = new QHBoxLayout;
  first->addWidget(m_index);
  first->addWidget(m_count);
  first->addStretch(1);
  first->addWidget(m_remove);
  grid->addWidget(new QLabel(tr("Way-point"), this), 0, 0);
  grid->addLayout(first, 0, 1, 1, 3);
  m_x = number("wayPointX", tr(" m"), -1000, 1000, 0.1, tr("To the left of the origin, metres"));
  m_z = number("wayPointZ", tr(" m"), -1000, 1000, 0.1, tr("Ahead of the origin, metres"));
  grid->addWidget(new QLabel(tr("x, z"), this), 1, 0);
  grid->addWidget(m_x, 1, 1);
  grid->addWidget(m_z, 1, 2, 1, 2);
  const auto row = [&](int at, QCheckBox*& own, const char* name, const QString& label,
                       const QString& toolTip, QDoubleSpinBox* box, const QString& otherwise) {
    own = new QCheckBox(label, this);
    own->setObjectName(QLatin1String(name));
    own->setToolTip(toolTip);
    grid->addWidget(own, at, 0);
    grid->addWidget(box, at, 1);
    auto* note = new QLabel(otherwise, this);
    note->setEnabled(false);
    grid->addWidget(note, at, 2, 1, 2);
  };
  m_speed = number("wayPointSpeed", tr(" m/s"), kSlowestMS, 20.0, 0.1, tr("Speed on leaving it"));
  row(2, m_ownSpeed, "wayPointOwnSpeed", tr("Speed"), tr("Leave it at a speed of its own"), m_speed,
      tr("else as before it"));
  m_facing = number("wayPointFacing", tr("°"), -360.0, 360.0, 5.0,
                    tr("Heading: 0° is ahead (+z), 90° is left (+x)"));
  row(3, m_ownFacing, "wayPointOwnFacing", tr("Facing"), tr("Face a direction of its own"),
      m_facing, tr("else along the path"));
  m_time = number("wayPointTime", tr(" s"), 0.0, 3600.0, 0.1, tr("When to be there"));
  row(4, m_ownTime, "wayPointOwnTime", tr("Time"), tr("Be there at a fixed time"), m_time,
      tr("else by speed"));
  m_type =
      new TypeBox("wayPointType", tr("Type of motion on leaving it, for models that know types"),
                  tr("as before it"), this);
  grid->addWidget(new QLabel(tr("Type"), this), 5, 0);
  grid->addWidget(m_type, 5, 1, 1, 3);
  grid->setColumnStretch(3, 1);
}

void WayPointForm::edit(const QString& label,
                        const std::function<void(PathEdit&, size_t)>& change) {
  const auto chosen = m_view.chosen();
  if (m_filling || !chosen) return;
  m_path.edit(label, [&](PathEdit& edit) { change(edit, *chosen); });
  refresh();  // a value that was held back shows as it is now
}

void WayPointForm::connectEdits() {
  const auto changed = qOverload<double>(&QDoubleSpinBox::valueChanged);
  connect(m_index, qOverload<int>(&QSpinBox::valueChanged), this, [this](int value) {
    if (m_filling) return;
    m_view.choose(value > 0 ? std::optional<size_t>(static_cast<size_t>(value) - 1) : std::nullopt);
  });
  connect(m_remove, &QPushButton::clicked, &m_view, &PathView::removeChosen);
  const auto move = [this] {
    edit(tr("Move way-point"),
         [this](PathEdit& e, size_t i) { e.move(i, m_x->value(), m_z->value()); });
  };
  connect(m_x, changed, this, move);
  connect(m_z, changed, this, move);
  const auto pair = [&](QCheckBox* own, QDoubleSpinBox* box, const std::function<void()>& apply) {
    connect(own, &QCheckBox::toggled, this, apply);
    connect(box, changed, this, apply);
  };
  const auto value = [](QCheckBox* own, QDoubleSpinBox* box, double scale) {
    return own->isChecked() ? std::optional<double>(box->value() * scale) : std::nullopt;
  };
  pair(m_ownSpeed, m_speed, [this, value] {
    edit(tr("Speed at way-point"),
         [this, value](PathEdit& e, size_t i) { e.setSpeed(i, value(m_ownSpeed, m_speed, 1.0)); });
  });
  pair(m_ownFacing, m_facing, [this, value] {
    edit(tr("Facing at way-point"), [this, value](PathEdit& e, size_t i) {
      e.setFacing(i, value(m_ownFacing, m_facing, 1.0 / kDegrees));
    });
  });
  pair(m_ownTime, m_time, [this, value] {
    edit(tr("Time of way-point"),
         [this, value](PathEdit& e, size_t i) { e.setTime(i, value(m_ownTime, m_time, 1.0)); });
  });
  connect(m_type, &TypeBox::typeChosen, this, [this](const std::string& type) {
    edit(tr("Type at way-point"), [type](PathEdit& e, size_t i) { e.setType(i, type); });
  });
}

void WayPointForm::refresh() {
  const auto& points = m_path.points();
  const auto chosen = m_view.chosen();
  const bool shown = chosen && *chosen < points.size();
  m_filling = true;
  m_index->setRange(0, static_cast<int>(points.size()));
  m_index->display(shown ? static_cast<int>(*chosen) + 1 : 0);
  m_count->setText(tr("of %1").arg(points.size()));
  m_remove->setEnabled(shown && points.size() > 2);
  for (QWidget* widget :
       std::initializer_list<QWidget*>{m_x, m_z, m_ownSpeed, m_ownFacing, m_ownTime, m_type})
    widget->setEnabled(shown);
  const WayPoint point = shown ? points[*chosen] : WayPoint{};
  m_x->display(point.x);
  m_z->display(point.z);
  m_ownSpeed->setChecked(point.speedMS.has_value());
  m_ownFacing->setChecked(point.facing.has_value());
  m_ownTime->setChecked(point.timeS.has_value());
  m_type->display(m_path.motionTypes(), point.type);
  m_speed->setEnabled(point.speedMS.has_value());
  m_facing->setEnabled(point.facing.has_value());
  m_time->setEnabled(point.timeS.has_value());
  if (shown) {
    // Values that are not fixed show what they come to, so that fixing them changes nothing.
    m_time->display(point.timeS.value_or(arrivalTimes(points)[*chosen]));
    const PathCurve& curve = m_path.curve();
    const bool sampled = !curve.frames.empty();
    m_speed->display(
        point.speedMS.value_or(sampled ? curve.speedMS[m_path.frameAt(*chosen)] : kUsualSpeedMS));
    m_facing->display(std::remainder(m_path.headingAt(*chosen), 2.0 * std::numbers::pi) * kDegrees);
  }
  m_filling = false;
}

}  // namespace marey::gui
