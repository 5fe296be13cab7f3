#include "render/live_floor.h"

#include <algorithm>
#include <array>

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkImageData.h>
#include <vtkOpenGLPolyDataMapper.h>
#include <vtkOpenGLVertexBufferObject.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkShaderProperty.h>
#include <vtkSmartPointer.h>
#include <vtkTexture.h>
#include <vtkUniforms.h>

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
uniform sampler2D shadowMap;
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
  vec3 colour = mix(floorColour, lineColour, max(line.x, line.y));
  float light = texture(shadowMap, (ground - shadowPlace.xy) * shadowPlace.zw).r;
  vec2 away = (ground - floorPlace.xy) * floorPlace.z;
  float seen = clamp((1.0 - dot(away, away)) * 1.25, 0.0, 1.0);
  gl_FragData[0] = vec4(colour * (1.0 - shadowDepth + shadowDepth * light), seen * seen);
}
)glsl";

constexpr Colour rgb(int r, int g, int b) {
  return {r / 255.0, g / 255.0, b / 255.0, 1.0};
}

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

const Backdrop& backdropOf(bool dark) {
  static const std::array<Backdrop, 2> backdrops = {
      Backdrop{rgb(236, 239, 243), rgb(248, 249, 251), rgb(206, 212, 220), rgb(110, 120, 133),
               0.75},
      Backdrop{rgb(22, 26, 33), rgb(34, 39, 48), rgb(58, 66, 79), rgb(150, 162, 178), 1.0}};
  return backdrops[dark ? 1 : 0];
}

struct LiveFloor::Internals {
  vtkSmartPointer<vtkActor> actor = vtkSmartPointer<vtkActor>::New();
  vtkSmartPointer<vtkPoints> points = vtkSmartPointer<vtkPoints>::New();
  vtkSmartPointer<vtkImageData> picture = vtkSmartPointer<vtkImageData>::New();
  double x = 0.0, z = 0.0, radiusM = 0.0, gridM = 0.5;

  vtkUniforms* uniforms() const { return actor->GetShaderProperty()->GetFragmentCustomUniforms(); }
  void place() {
    setFour(uniforms(), "floorPlace", x, z, 1.0 / std::max(1e-3, radiusM), 0.0);
    setFour(uniforms(), "floorGrid", 1.0 / gridM, gridM, 0.009 / gridM, 0.0);
  }
};

LiveFloor::LiveFloor(vtkRenderer* renderer) : m_internals(std::make_unique<Internals>()) {
  Internals& i = *m_internals;
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  const vtkIdType first[3] = {0, 2, 1}, second[3] = {0, 3, 2};
  cells->InsertNextCell(3, first);
  cells->InsertNextCell(3, second);
  auto quad = vtkSmartPointer<vtkPolyData>::New();
  i.points->SetNumberOfPoints(4);
  quad->SetPoints(i.points);
  quad->SetPolys(cells);
  auto mapper = vtkSmartPointer<vtkOpenGLPolyDataMapper>::New();
  mapper->SetInputData(quad);
  mapper->SetVBOShiftScaleMethod(vtkOpenGLVertexBufferObject::DISABLE_SHIFT_SCALE);
  i.actor->SetMapper(mapper);
  i.actor->ForceOpaqueOn();
  i.actor->PickableOff();
  i.actor->UseBoundsOff();
  i.actor->GetShaderProperty()->SetVertexShaderCode(floorVertexShader);
  i.actor->GetShaderProperty()->SetFragmentShaderCode(floorFragmentShader);
  auto texture = vtkSmartPointer<vtkTexture>::New();
  texture->SetInputData(i.picture);
  texture->SetColorModeToDirectScalars();
  texture->InterpolateOn();
  texture->RepeatOff();
  texture->EdgeClampOn();
  i.actor->GetProperty()->SetTexture("shadowMap", texture);
  setShadows({});
  setLook(backdropOf(false), 0.5);
  setPlace(0.0, 0.0, 5.0);
  renderer->AddActor(i.actor);
}

LiveFloor::~LiveFloor() = default;

void LiveFloor::setVisible(bool visible) {
  m_internals->actor->SetVisibility(visible ? 1 : 0);
}

void LiveFloor::setPlace(double x, double z, double radiusM) {
  Internals& i = *m_internals;
  if (i.x == x && i.z == z && i.radiusM == radiusM) return;
  i.x = x;
  i.z = z;
  i.radiusM = radiusM;
  i.points->SetPoint(0, x - radiusM, 0, z - radiusM);
  i.points->SetPoint(1, x + radiusM, 0, z - radiusM);
  i.points->SetPoint(2, x + radiusM, 0, z + radiusM);
  i.points->SetPoint(3, x - radiusM, 0, z + radiusM);
  i.points->Modified();
  i.place();
}

void LiveFloor::setLook(const Backdrop& backdrop, double gridM) {
  Internals& i = *m_internals;
  i.gridM = gridM;
  i.place();
  setColour(i.uniforms(), "floorColour", backdrop.floor);
  setColour(i.uniforms(), "lineColour", backdrop.line);
  i.uniforms()->SetUniformf("shadowDepth", static_cast<float>(backdrop.shadow));
}

void LiveFloor::setShadows(const ShadowMap& map) {
  Internals& i = *m_internals;
  int size[3];
  i.picture->GetDimensions(size);
  if (size[0] != map.width || size[1] != map.height) {
    i.picture->SetDimensions(map.width, map.height, 1);
    i.picture->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  }
  std::copy(map.light.begin(), map.light.end(),
            static_cast<uint8_t*>(i.picture->GetScalarPointer()));
  i.picture->Modified();
  setFour(i.uniforms(), "shadowPlace", map.area.x0, map.area.z0, 1.0 / map.area.width(),
          1.0 / map.area.depth());
}

}  // namespace marey::render
