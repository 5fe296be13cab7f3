#include "render/scene/vtk_parts.h"

#include <algorithm>
#include <cmath>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTypeInt32Array.h>
#include <vtkUnsignedCharArray.h>

namespace marey::render {

namespace {
vtkSmartPointer<vtkFloatArray> floatArray(const std::vector<float>& values, int components) {
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / components);
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

vtkSmartPointer<vtkPolyData> floorQuad(double x0, double z0, double x1, double z1, double height) {
  const auto f = [](double v) { return static_cast<float>(v); };
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetData(floatArray({f(x0), f(height), f(z0), f(x1), f(height), f(z0), f(x1), f(height),
                              f(z1), f(x0), f(height), f(z1)},
                             3));
  auto coordinates = floatArray({0, 0, 1, 0, 1, 1, 0, 1}, 2);
  coordinates->SetName("texture");
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  const vtkIdType corners[4] = {0, 3, 2, 1};
  cells->InsertNextCell(4, corners);
  auto quad = vtkSmartPointer<vtkPolyData>::New();
  quad->SetPoints(points);
  quad->GetPointData()->SetTCoords(coordinates);
  quad->SetPolys(cells);
  return quad;
}
}  // namespace

vtkSmartPointer<vtkPolyData> toPolyData(const Mesh& mesh) {
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetData(floatArray(mesh.positions, 3));
  auto colours = vtkSmartPointer<vtkUnsignedCharArray>::New();
  colours->SetNumberOfComponents(3);
  colours->SetNumberOfTuples(static_cast<vtkIdType>(mesh.colours.size()) / 3);
  std::copy(mesh.colours.begin(), mesh.colours.end(), colours->GetPointer(0));
  auto corners = vtkSmartPointer<vtkTypeInt32Array>::New();
  corners->SetNumberOfValues(static_cast<vtkIdType>(mesh.triangles.size()));
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), corners->GetPointer(0));
  auto offsets = vtkSmartPointer<vtkTypeInt32Array>::New();
  offsets->SetNumberOfValues(static_cast<vtkIdType>(mesh.triangles.size()) / 3 + 1);
  for (vtkIdType i = 0; i < offsets->GetNumberOfValues(); ++i) {
    offsets->SetValue(i, static_cast<vtkTypeInt32>(3 * i));
  }
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, corners);
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->GetPointData()->SetNormals(floatArray(mesh.normals, 3));
  data->GetPointData()->SetScalars(colours);
  data->SetPolys(cells);
  return data;
}

vtkSmartPointer<vtkActor> bodyActor(const Mesh& mesh) {
  auto mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
  mapper->SetInputData(toPolyData(mesh));
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  vtkProperty* material = actor->GetProperty();
  material->SetInterpolationToPhong();
  material->SetAmbient(0.38);
  material->SetDiffuse(0.72);
  material->SetSpecular(0.16);
  material->SetSpecularPower(18.0);
  return actor;
}

vtkSmartPointer<vtkTexture> toTexture(const Image& image) {
  auto data = vtkSmartPointer<vtkImageData>::New();
  data->SetDimensions(image.width, image.height, 1);
  data->AllocateScalars(VTK_UNSIGNED_CHAR, 4);
  std::copy(image.pixels.begin(), image.pixels.end(),
            static_cast<uint8_t*>(data->GetScalarPointer()));
  auto texture = vtkSmartPointer<vtkTexture>::New();
  texture->SetInputData(data);
  texture->SetColorModeToDirectScalars();
  texture->InterpolateOn();
  texture->MipmapOn();
  texture->SetMaximumAnisotropicFiltering(4.0F);
  texture->RepeatOff();
  texture->EdgeClampOn();
  return texture;
}

vtkSmartPointer<vtkActor> floorActor(const Image& image, double x0, double z0, double x1, double z1,
                                     double heightM) {
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(vtkSmartPointer<vtkPolyDataMapper>::New());
  actor->GetProperty()->LightingOff();
  setFloorPicture(actor, image, x0, z0, x1, z1, heightM);
  return actor;
}

void setFloorPicture(vtkActor* actor, const Image& image, double x0, double z0, double x1,
                     double z1, double heightM) {
  vtkPolyDataMapper::SafeDownCast(actor->GetMapper())
      ->SetInputData(floorQuad(x0, z0, x1, z1, heightM));
  actor->SetTexture(toTexture(image));
  // The opaque pass blends as well, and the floor's pictures are added from below to above: that
  // spares the costly passes for see-through surfaces.
  actor->ForceOpaqueOn();
}

void addLights(vtkRenderer* renderer) {
  const auto add = [&](double x, double y, double z, double intensity) {
    auto light = vtkSmartPointer<vtkLight>::New();
    light->SetLightTypeToCameraLight();
    light->SetPosition(x, y, z);
    light->SetFocalPoint(0, 0, 0);
    light->SetIntensity(intensity);
    renderer->AddLight(light);
  };
  renderer->AutomaticLightCreationOff();
  add(-0.55, 0.9, 0.8, 0.85);
  add(0.9, 0.1, 0.6, 0.30);
}

void applyCamera(const Camera& camera, vtkCamera* target) {
  target->SetPosition(camera.eye.x(), camera.eye.y(), camera.eye.z());
  target->SetFocalPoint(camera.target.x(), camera.target.y(), camera.target.z());
  target->SetViewUp(camera.up.x(), camera.up.y(), camera.up.z());
  target->SetParallelProjection(camera.orthographic ? 1 : 0);
  target->SetViewAngle(camera.fovY * 180.0 / M_PI);
  target->SetParallelScale(camera.heightM / 2);
  target->SetClippingRange(camera.nearM, camera.farM);
}

}  // namespace marey::render
