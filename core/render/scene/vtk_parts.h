// VTK objects from Marey's own data, for every program that shows a scene. The only header of
// the folder that names VTK types.
#pragma once

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTexture.h>

#include "render/base/camera.h"
#include "render/base/image.h"
#include "render/scene/bodies.h"

namespace marey::render {

/// Points, normals, RGB point colours and triangles of a mesh.
vtkSmartPointer<vtkPolyData> toPolyData(const Mesh& mesh);
/// A mesh with the material of bodies.
vtkSmartPointer<vtkActor> bodyActor(const Mesh& mesh);
vtkSmartPointer<vtkTexture> toTexture(const Image& image);
/// An unlit picture on the floor at height `heightM`, covering x0..x1, z0..z1 (metres).
vtkSmartPointer<vtkActor> floorActor(const Image& image, double x0, double z0, double x1, double z1,
                                     double heightM);
/// Exchanges the picture of a floorActor.
void setFloorPicture(vtkActor* actor, const Image& image, double x0, double z0, double x1,
                     double z1, double heightM);
/// A key light from the upper left of the viewer and a weak fill light, both tied to the camera.
void addLights(vtkRenderer* renderer);
void applyCamera(const Camera& camera, vtkCamera* target);

}  // namespace marey::render
