#include "render/scene/scene_floor.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkImageData.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLPolyDataMapper.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkOpenGLVertexBufferObject.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkShaderProperty.h>
#include <vtkSmartPointer.h>
#include <vtkTexture.h>
#include <vtkUniforms.h>
#include <vtk_glew.h>

#include "render/scene/kept_picture.h"
#include "render/scene/shadow_tiles.h"

namespace marey::render {

namespace {
constexpr const char* floorVertexShader = R"glsl(
//VTK::System::Dec
in vec4 vertexMC;
uniform mat4 MCDCMatrix;
out vec2 ground;
void main()
{
  ground = vertexMC.xz;
  gl_Position = MCDCMatrix * vertexMC;
}
)glsl";

// A line narrower than a pixel is drawn one pixel wide and fainter, and where cells come down to a
// few pixels the grid fades, so that it neither flickers nor makes waves far away. It is most of
// the picture, so every operation counts.
constexpr const char* floorFragmentShader = R"glsl(
//VTK::System::Dec
//VTK::Output::Dec
//VTK::CustomUniforms::Dec
in vec2 ground;

void main()
{
  vec2 cell = ground * floorGrid.x;
  vec2 pixel = fwidth(cell);
  vec2 nearest = floor(cell + 0.5);
  vec2 drawn = max(vec2(floorGrid.z), 0.5 * pixel);
  vec2 line = clamp((drawn - abs(cell - nearest)) / pixel + 0.5, 0.0, 1.0);
  // 1 on whole metres.
  vec2 strong = clamp(1.0 - 64.0 * abs(fract(nearest * floorGrid.y + 0.5) - 0.5), 0.0, 1.0);
  line *= (0.45 + 0.55 * strong) * clamp(1.3 - (3.4 - 1.7 * strong) * pixel, 0.0, 1.0);
  vec2 away = (ground - floorPlace.xy) * floorPlace.z;
  float seen = clamp((1.0 - dot(away, away)) * 1.25, 0.0, 1.0);
  gl_FragData[0] = vec4(mix(floorColour, lineColour, max(line.x, line.y)), seen * seen);
}
)glsl";

// What is left of the light on the floor, by which its colours are multiplied.
constexpr const char* shadowFragmentShader = R"glsl(
//VTK::System::Dec
//VTK::Output::Dec
//VTK::CustomUniforms::Dec
uniform sampler2D shadowMap;
in vec2 ground;

void main()
{
  float light = texture(shadowMap, (ground - shadowPlace.xy) * shadowPlace.zw).r;
  vec2 away = (ground - floorPlace.xy) * floorPlace.z;
  float seen = clamp((1.0 - dot(away, away)) * 1.25, 0.0, 1.0);
  gl_FragData[0] = vec4(vec3(1.0 - seen * seen * shadowDepth * (1.0 - light)), 1.0);
}
)glsl";

vtkOpenGLState* stateOf(vtkRenderer* renderer) {
  return static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow())->GetState();
}

/// Draws the floor, or copies it from an earlier drawing.
class FloorMapper : public vtkOpenGLPolyDataMapper {
 public:
  static FloorMapper* New();
  vtkTypeMacro(FloorMapper, vtkOpenGLPolyDataMapper);

  /// To be called whenever what is drawn changes.
  void changeLook() { ++m_look; }

  /// To be called before each drawing; true where it will copy.
  bool prepare(vtkRenderer* renderer) {
    m_key = PictureKey::of(renderer, m_look);
    return m_kept.holds(m_key);
  }

  void RenderPieceDraw(vtkRenderer* renderer, vtkActor* actor) override {
    if (m_kept.holds(m_key)) {
      m_kept.restore(renderer);
      return;
    }
    Superclass::RenderPieceDraw(renderer, actor);
    m_kept.keep(renderer, m_key);
  }

  void ReleaseGraphicsResources(vtkWindow* window) override {
    m_kept.release(window);
    Superclass::ReleaseGraphicsResources(window);
  }

 private:
  KeptPicture m_kept;
  PictureKey m_key;  ///< of the present drawing
  uint64_t m_look = 0;
};
vtkStandardNewMacro(FloorMapper);

/// Multiplies the floor by what is left of the light. It lies in the plane of the floor and is
/// drawn when nothing else is there, so that depth need not be asked.
class ShadowMapper : public vtkOpenGLPolyDataMapper {
 public:
  static ShadowMapper* New();
  vtkTypeMacro(ShadowMapper, vtkOpenGLPolyDataMapper);

  void RenderPieceDraw(vtkRenderer* renderer, vtkActor* actor) override {
    vtkOpenGLState* state = stateOf(renderer);
    const vtkOpenGLState::ScopedglBlendFuncSeparate blending(state);
    const vtkOpenGLState::ScopedglEnableDisable depth(state, GL_DEPTH_TEST);
    state->vtkglBlendFuncSeparate(GL_ZERO, GL_SRC_COLOR, GL_ZERO, GL_ONE);
    state->vtkglDisable(GL_DEPTH_TEST);
    Superclass::RenderPieceDraw(renderer, actor);
  }
};
vtkStandardNewMacro(ShadowMapper);

void setColour(vtkUniforms* uniforms, const char* name, const Colour& c) {
  const float values[3] = {static_cast<float>(c.r), static_cast<float>(c.g),
                           static_cast<float>(c.b)};
  uniforms->SetUniform3f(name, values);
}

void setFour(vtkUniforms* uniforms, const char* name, double a, double b, double c, double d) {
  const float values[4] = {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c),
                           static_cast<float>(d)};
  uniforms->SetUniform4f(name, values);
}
}  // namespace

struct SceneFloor::Internals {
  /// Polygons on the floor with a program of their own.
  struct Layer {
    vtkSmartPointer<vtkActor> actor = vtkSmartPointer<vtkActor>::New();
    vtkSmartPointer<vtkPoints> points = vtkSmartPointer<vtkPoints>::New();
    vtkSmartPointer<vtkCellArray> cells = vtkSmartPointer<vtkCellArray>::New();

    void start(vtkRenderer* renderer, vtkOpenGLPolyDataMapper* mapper, const char* program);
    void cover(std::span<const FloorArea> areas);
    vtkUniforms* uniforms() const {
      return actor->GetShaderProperty()->GetFragmentCustomUniforms();
    }
  };
  // In the order of drawing.
  Layer ground, shadows;
  vtkSmartPointer<FloorMapper> mapper = vtkSmartPointer<FloorMapper>::New();
  vtkSmartPointer<vtkImageData> picture = vtkSmartPointer<vtkImageData>::New();
  double x = 0.0, z = 0.0, radiusM = 0.0, gridM = 0.5;
  bool visible = true, shaded = false;

  void place();
  void show() {
    ground.actor->SetVisibility(visible ? 1 : 0);
    shadows.actor->SetVisibility(visible && shaded ? 1 : 0);
  }
};

void SceneFloor::Internals::Layer::start(vtkRenderer* renderer, vtkOpenGLPolyDataMapper* mapper,
                                         const char* program) {
  auto polygons = vtkSmartPointer<vtkPolyData>::New();
  polygons->SetPoints(points);
  polygons->SetPolys(cells);
  mapper->SetInputData(polygons);
  mapper->SetVBOShiftScaleMethod(vtkOpenGLVertexBufferObject::DISABLE_SHIFT_SCALE);
  actor->SetMapper(mapper);
  actor->ForceOpaqueOn();
  actor->PickableOff();
  actor->UseBoundsOff();
  actor->GetShaderProperty()->SetVertexShaderCode(floorVertexShader);
  actor->GetShaderProperty()->SetFragmentShaderCode(program);
  renderer->AddActor(actor);
}

void SceneFloor::Internals::Layer::cover(std::span<const FloorArea> areas) {
  points->SetNumberOfPoints(4 * static_cast<vtkIdType>(areas.size()));
  cells->Reset();
  vtkIdType at = 0;
  for (const FloorArea& area : areas) {
    points->SetPoint(at, area.x0, 0, area.z0);
    points->SetPoint(at + 1, area.x1, 0, area.z0);
    points->SetPoint(at + 2, area.x1, 0, area.z1);
    points->SetPoint(at + 3, area.x0, 0, area.z1);
    const vtkIdType first[3] = {at, at + 2, at + 1}, second[3] = {at, at + 3, at + 2};
    cells->InsertNextCell(3, first);
    cells->InsertNextCell(3, second);
    at += 4;
  }
  points->Modified();
  cells->Modified();
}

void SceneFloor::Internals::place() {
  for (const Layer* layer : {&ground, &shadows})
    setFour(layer->uniforms(), "floorPlace", x, z, 1.0 / std::max(1e-3, radiusM), 0.0);
  setFour(ground.uniforms(), "floorGrid", 1.0 / gridM, gridM, 0.009 / gridM, 0.0);
  mapper->changeLook();
}

SceneFloor::SceneFloor(vtkRenderer* renderer) : m_internals(std::make_unique<Internals>()) {
  Internals& i = *m_internals;
  i.ground.start(renderer, i.mapper, floorFragmentShader);
  i.shadows.start(renderer, vtkSmartPointer<ShadowMapper>::New(), shadowFragmentShader);
  auto texture = vtkSmartPointer<vtkTexture>::New();
  texture->SetInputData(i.picture);
  texture->SetColorModeToDirectScalars();
  texture->InterpolateOn();
  texture->RepeatOff();
  texture->EdgeClampOn();
  i.shadows.actor->GetProperty()->SetTexture("shadowMap", texture);
  setShadows({});
  setLook(backdropOf(Tone::Light), 0.5);
  setPlace(0.0, 0.0, 5.0);
}

SceneFloor::~SceneFloor() = default;

void SceneFloor::setVisible(bool visible) {
  m_internals->visible = visible;
  m_internals->show();
}

bool SceneFloor::prepare(vtkRenderer* renderer) {
  // What is copied over the whole view need not be cleared before.
  const bool copied = m_internals->visible && m_internals->mapper->prepare(renderer);
  renderer->SetPreserveColorBuffer(copied ? 1 : 0);
  renderer->SetPreserveDepthBuffer(copied ? 1 : 0);
  return copied;
}

void SceneFloor::setPlace(double x, double z, double radiusM) {
  Internals& i = *m_internals;
  if (i.x == x && i.z == z && i.radiusM == radiusM) return;
  i.x = x;
  i.z = z;
  i.radiusM = radiusM;
  const FloorArea whole{x - radiusM, z - radiusM, x + radiusM, z + radiusM};
  i.ground.cover({&whole, 1});
  i.place();
}

void SceneFloor::setLook(const Backdrop& backdrop, double gridM) {
  Internals& i = *m_internals;
  i.gridM = gridM;
  i.place();
  setColour(i.ground.uniforms(), "floorColour", backdrop.floor);
  setColour(i.ground.uniforms(), "lineColour", backdrop.line);
  i.shadows.uniforms()->SetUniformf("shadowDepth", static_cast<float>(backdrop.shadow));
}

void SceneFloor::setShadows(const ShadowMap& map) {
  Internals& i = *m_internals;
  const std::vector<FloorArea> areas = shadedAreas(map);
  i.shaded = !areas.empty();
  i.show();
  if (areas.empty()) return;
  i.shadows.cover(areas);
  int size[3];
  i.picture->GetDimensions(size);
  if (size[0] != map.width || size[1] != map.height) {
    i.picture->SetDimensions(map.width, map.height, 1);
    i.picture->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  }
  std::copy(map.light.begin(), map.light.end(),
            static_cast<uint8_t*>(i.picture->GetScalarPointer()));
  i.picture->Modified();
  setFour(i.shadows.uniforms(), "shadowPlace", map.area.x0, map.area.z0, 1.0 / map.area.width(),
          1.0 / map.area.depth());
}

}  // namespace marey::render
