// How fast a scene is drawn, against the plain way of drawing it.
#pragma once

#include "base/job.h"
#include "render/scene/scene.h"

namespace marey::render {

struct RenderBenchSpec {
  int motions = 200;  ///< procedural walkers on paths next to and across each other
  int frames = 120;   ///< drawn, one after the other in time
  BodyDetail detail = BodyDetail::Auto;
  int width = 1280, height = 720;  ///< pixels
  uint64_t seed = 1;
};

/// Times are means over the frames drawn, milliseconds.
struct RenderBenchResult {
  double msPerFrame = 0.0;     ///< until the last pixel is there
  double cpuMsPerFrame = 0.0;  ///< of all threads together
  double fillMs = 0.0;         ///< the part of it before OpenGL: poses, vertices, shadows
  int joints = 0;              ///< of one motion
  bool lines = false;          ///< whether lines were drawn
  double referenceMsPerFrame = 0.0;
  int referenceFrames = 0;
};

/// The walkers of the benchmark, standing in rows and walking a few seconds.
std::vector<SceneMotion> benchMotions(int motions, uint64_t seed);

/// Draws every frame without a display, then some by the plain way of VTK: all bones as tubes that
/// are built anew for every frame, without floor and shadows. Throws InputError unless there is at
/// least one motion and frame and the size is 32x32 or more.
RenderBenchResult benchRender(const RenderBenchSpec& spec, Progress& progress);

}  // namespace marey::render
