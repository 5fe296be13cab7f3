#include "render/scene/strokes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkDataObject.h>
#include <vtkFloatArray.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLPolyDataMapper.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkOpenGLVertexBufferObject.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkShaderProperty.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt32Array.h>
#include <vtkUniforms.h>
#include <vtk_glew.h>

#include "render/scene/stroke_shaders.h"

namespace marey::render {

namespace {
/// The width of a slanted line is measured along an axis of the window; this covers thin strokes
/// and their soft edges at every slant: 2 * sqrt(2) * (thinLinePixels + 0.5).
constexpr float rasterPixels = 3.7F;
static_assert(rasterPixels * rasterPixels >
              8.0F * (thinLinePixels + 0.5F) * (thinLinePixels + 0.5F));

vtkOpenGLState* stateOf(vtkRenderer* renderer) {
  return static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow())->GetState();
}

/// VTK would draw wide lines by a geometry shader of its own wherever it has not asked the context
/// for its widths, as in contexts that others made.
class WideLineMapper : public vtkOpenGLPolyDataMapper {
 public:
  static WideLineMapper* New();
  vtkTypeMacro(WideLineMapper, vtkOpenGLPolyDataMapper);

 protected:
  bool HaveWideLines(vtkRenderer*, vtkActor*) override { return false; }
};
vtkStandardNewMacro(WideLineMapper);

struct Programs {
  const char *vertex, *fragment;
};

Programs programsOf(StrokeLook look) {
  switch (look) {
    case StrokeLook::Limbs:
    case StrokeLook::LimbsAgain:
      return {limbVertexShader, limbFragmentShader};
    case StrokeLook::Flat:
      return {flatVertexShader, flatFragmentShader};
    case StrokeLook::Thin:
      break;
  }
  return {thinVertexShader, thinFragmentShader};
}

template <class Array>
vtkSmartPointer<Array> namedArray(const char* name, int components) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  return array;
}

/// Cells of `corners` points each.
vtkSmartPointer<vtkCellArray> cellsOf(vtkTypeInt32Array* indices, vtkIdType corners) {
  auto offsets = vtkSmartPointer<vtkTypeInt32Array>::New();
  offsets->SetNumberOfValues(indices->GetNumberOfValues() / corners + 1);
  for (vtkIdType i = 0; i < offsets->GetNumberOfValues(); ++i)
    offsets->SetValue(i, static_cast<vtkTypeInt32>(corners * i));
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, indices);
  return cells;
}

/// A line for each of the strokes [first, last).
vtkSmartPointer<vtkCellArray> segments(size_t first, size_t last) {
  auto indices = vtkSmartPointer<vtkTypeInt32Array>::New();
  indices->SetNumberOfValues(2 * static_cast<vtkIdType>(last - first));
  std::iota(indices->GetPointer(0), indices->GetPointer(0) + indices->GetNumberOfValues(),
            static_cast<vtkTypeInt32>(2 * first));
  return cellsOf(indices, 2);
}

/// Two triangles for each of the strokes [first, last).
vtkSmartPointer<vtkCellArray> quads(size_t first, size_t last) {
  auto indices = vtkSmartPointer<vtkTypeInt32Array>::New();
  indices->SetNumberOfValues(6 * static_cast<vtkIdType>(last - first));
  vtkTypeInt32* at = indices->GetPointer(0);
  for (size_t s = first; s < last; ++s) {
    const auto v = static_cast<vtkTypeInt32>(4 * s);
    for (const int corner : {0, 2, 1, 1, 2, 3}) *at++ = v + corner;
  }
  return cellsOf(indices, 3);
}

std::array<float, 3> floats(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
}  // namespace

Rgba rgbaOf(const Colour& colour) {
  const auto byte = [](double v) {
    return static_cast<uint8_t>(std::lround(std::clamp(v, 0.0, 1.0) * 255.0));
  };
  return {byte(colour.r), byte(colour.g), byte(colour.b), byte(colour.a)};
}

bool drawsThinStrokes(vtkRenderer* renderer) {
  vtkOpenGLState* state = stateOf(renderer);
  float widths[2] = {0.0F, 0.0F};
  state->vtkglGetFloatv(GL_ALIASED_LINE_WIDTH_RANGE, widths);
  int flags = 0;
  state->vtkglGetIntegerv(GL_CONTEXT_FLAGS, &flags);
  // Contexts without what is deprecated refuse wide lines, whatever the range.
  return widths[1] >= rasterPixels && (flags & GL_CONTEXT_FLAG_FORWARD_COMPATIBLE_BIT) == 0;
}

struct StrokeBatch::Internals {
  vtkSmartPointer<vtkRenderer> renderer;
  StrokeLook look = StrokeLook::Limbs;
  int layers = 0;
  size_t capacity = 0;
  std::vector<size_t> cuts;  ///< where each layer begins, and the end of the last
  vtkSmartPointer<vtkFloatArray> from = namedArray<vtkFloatArray>("strokeFrom", 4);
  vtkSmartPointer<vtkFloatArray> to = namedArray<vtkFloatArray>("strokeTo", 4);
  /// Red, green and blue in one number, opacity and kind in another: floats hold 24 bits exactly,
  /// and VTK would turn bytes into as many floats.
  vtkSmartPointer<vtkFloatArray> ink = namedArray<vtkFloatArray>("strokeInk", 2);
  /// Which corner each vertex is. Its place comes with the arrays: VTK leaves out triangles whose
  /// points lie together, as those of a stroke do until the shader spreads them.
  vtkSmartPointer<vtkPoints> points = vtkSmartPointer<vtkPoints>::New();

  bool thin() const { return look == StrokeLook::Thin; }
  bool round() const { return look == StrokeLook::Limbs || look == StrokeLook::LimbsAgain; }
  size_t corners() const { return thin() ? 2 : 4; }
  std::array<vtkFloatArray*, 3> arrays() { return {from, to, ink}; }
  std::vector<vtkSmartPointer<vtkPolyData>> parts;  ///< one per layer; all share the arrays
  std::vector<vtkSmartPointer<vtkActor>> actors;

  void addActor(vtkPolyData* part, int pass);
  void addPart();
  void cut(size_t count, std::span<const uint32_t> starts);
  void resize(size_t count);
};

void StrokeBatch::Internals::addActor(vtkPolyData* part, int pass) {
  vtkSmartPointer<vtkOpenGLPolyDataMapper> mapper;
  if (thin())
    mapper = vtkSmartPointer<WideLineMapper>::New();
  else
    mapper = vtkSmartPointer<vtkOpenGLPolyDataMapper>::New();
  mapper->SetInputData(part);
  mapper->ScalarVisibilityOff();
  mapper->SetVBOShiftScaleMethod(vtkOpenGLVertexBufferObject::DISABLE_SHIFT_SCALE);
  for (const char* name : {"strokeFrom", "strokeTo", "strokeInk"}) {
    mapper->MapDataArrayToVertexAttribute(name, name, vtkDataObject::FIELD_ASSOCIATION_POINTS, -1);
  }
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  // The opaque pass blends as well and keeps the order of the actors; strokes bring their own.
  actor->ForceOpaqueOn();
  actor->PickableOff();
  actor->UseBoundsOff();
  vtkShaderProperty* shaders = actor->GetShaderProperty();
  shaders->SetVertexShaderCode(programsOf(look).vertex);
  shaders->SetFragmentShaderCode(programsOf(look).fragment);
  if (round()) shaders->GetFragmentCustomUniforms()->SetUniformi("strokePass", pass);
  if (thin()) actor->GetProperty()->SetLineWidth(rasterPixels);
  renderer->AddActor(actor);
  actors.push_back(actor);
}

void StrokeBatch::Internals::addPart() {
  auto part = vtkSmartPointer<vtkPolyData>::New();
  part->SetPoints(points);
  for (vtkFloatArray* array : arrays()) part->GetPointData()->AddArray(array);
  parts.push_back(part);
  const bool again = look == StrokeLook::LimbsAgain;
  if (again || layers > 0) addActor(part, again ? 3 : 1);
  addActor(part, again ? 4 : layers > 0 ? 2 : 0);
}

void StrokeBatch::Internals::resize(size_t count) {
  capacity = std::max<size_t>(16, count + count / 2);
  const auto tuples = static_cast<vtkIdType>(corners() * capacity);
  for (vtkFloatArray* array : arrays()) array->SetNumberOfTuples(tuples);
  points->SetNumberOfPoints(tuples);
  for (vtkIdType v = 0; v < tuples; ++v) {
    const vtkIdType end = thin() ? v & 1 : (v >> 1) & 1, side = thin() ? 0 : v & 1;
    points->SetPoint(v, static_cast<double>(end), static_cast<double>(side), 0.0);
  }
  points->Modified();
  // What lies beyond the strokes in use is never drawn, but it is uploaded.
  for (vtkFloatArray* array : arrays()) array->FillValue(0.0F);
}

void StrokeBatch::Internals::cut(size_t count, std::span<const uint32_t> starts) {
  std::vector<size_t> next(parts.size() + 1, count);
  for (size_t g = 0; g < parts.size(); ++g) {
    const size_t figure = g * starts.size() / parts.size();
    next[g] = figure < starts.size() ? starts[figure] : 0;
  }
  if (next == cuts) return;
  cuts = std::move(next);
  for (size_t g = 0; g < parts.size(); ++g) {
    if (thin())
      parts[g]->SetLines(segments(cuts[g], cuts[g + 1]));
    else
      parts[g]->SetPolys(quads(cuts[g], cuts[g + 1]));
  }
}

StrokeBatch::StrokeBatch(vtkRenderer* renderer, StrokeLook look, int layers)
    : m_internals(std::make_unique<Internals>()) {
  m_internals->renderer = renderer;
  m_internals->look = look;
  m_internals->layers = layers;
  for (int part = 0; part < std::max(1, layers); ++part) m_internals->addPart();
  set({}, {});
}

// The actors end with the renderer: whether a context for their buffers is current is not known
// here.
StrokeBatch::~StrokeBatch() = default;

void StrokeBatch::set(std::span<const Stroke> strokes, std::span<const uint32_t> order,
                      std::span<const uint32_t> starts) {
  Internals& i = *m_internals;
  for (const auto& actor : i.actors) actor->SetVisibility(order.empty() ? 0 : 1);
  if (order.empty()) return;
  if (order.size() > i.capacity || 4 * order.size() < i.capacity) i.resize(order.size());
  float* from = i.from->GetPointer(0);
  float* to = i.to->GetPointer(0);
  float* ink = i.ink->GetPointer(0);
  for (const uint32_t index : order) {
    const Stroke& s = strokes[index];
    const auto colour = static_cast<float>(s.colour[0] + 256 * s.colour[1] + 65536 * s.colour[2]);
    const auto rest = static_cast<float>(s.colour[3] + 256 * static_cast<int>(s.kind));
    for (size_t corner = 0; corner < i.corners(); ++corner) {
      from = std::copy_n(s.from.data(), 3, from);
      *from++ = s.radiusFrom;
      to = std::copy_n(s.to.data(), 3, to);
      *to++ = s.radiusTo;
      *ink++ = colour;
      *ink++ = rest;
    }
  }
  i.cut(order.size(), starts);
  for (vtkFloatArray* array : i.arrays()) array->Modified();
  for (const auto& part : i.parts) part->Modified();
}

void StrokeBatch::setView(const StrokeView& view) {
  const Camera& camera = view.camera;
  const Vec3 right = camera.right(), up = camera.trueUp(), back = -camera.forward();
  const Vec3 key = (-0.55F * right + 0.9F * up + 0.8F * back).normalized();
  const Vec3 fill = (0.9F * right + 0.1F * up + 0.6F * back).normalized();
  const Vec3 gloss = (key + back).normalized();
  const Vec3 eye = camera.orthographic ? back : camera.eye;
  const float seen[4] = {eye.x(), eye.y(), eye.z(), camera.orthographic ? 0.0F : 1.0F};
  const double across = camera.orthographic ? camera.heightM : 2.0 * std::tan(0.5 * camera.fovY);
  // Window depth, 0 to 1, for one metre towards the viewer.
  const double span = camera.farM - camera.nearM;
  const double depth = camera.orthographic ? 1.0 / span : camera.nearM * camera.farM / span;
  for (const auto& actor : m_internals->actors) {
    vtkUniforms* vertex = actor->GetShaderProperty()->GetVertexCustomUniforms();
    vertex->SetUniform4f("strokeEye", seen);
    vertex->SetUniformf("strokePixel", static_cast<float>(across / view.viewport[3]));
    if (m_internals->thin()) {
      const auto [left, low, width, height] = view.viewport;
      const float window[4] = {static_cast<float>(left), static_cast<float>(low),
                               static_cast<float>(width), static_cast<float>(height)};
      vertex->SetUniform4f("strokeWindow", window);
    }
    if (!m_internals->round()) continue;
    vertex->SetUniformf("strokeDepth", static_cast<float>(depth));
    vertex->SetUniform3f("strokeKey", floats(key).data());
    vertex->SetUniform3f("strokeFill", floats(fill).data());
    vertex->SetUniform3f("strokeGloss", floats(gloss).data());
  }
}

}  // namespace marey::render
