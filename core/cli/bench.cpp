// marey bench; and of it render: the fast path and the plain reference path, measured in one run.
#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "cli/command.h"
#include "render/scene/render_bench.h"

namespace marey::cli {
namespace {

struct Options {
  render::RenderBenchSpec render;
  std::string detail = "auto", size = "1280x720";
};

render::BodyDetail detailNamed(const std::string& name) {
  if (name == "capsules") return render::BodyDetail::Capsules;
  return name == "lines" ? render::BodyDetail::Lines : render::BodyDetail::Auto;
}

void parseSize(const std::string& text, int& width, int& height) {
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) == 2 && width >= 32 &&
      height >= 32 && width <= 8192 && height <= 8192)
    return;
  throw UsageError(
      fmt::format("--size: expected WIDTHxHEIGHT from 32x32 to 8192x8192, found '{}'", text));
}

void runRender(Options& o, const Context& context) {
  render::RenderBenchSpec& spec = o.render;
  parseSize(o.size, spec.width, spec.height);
  spec.detail = detailNamed(o.detail);
  spec.seed = context.seed;
  Progress progress = context.progress("bench render");
  const render::RenderBenchResult r = render::benchRender(spec, progress);
  const double ratio = r.referenceMsPerFrame / r.msPerFrame;
  const std::string drawn = r.lines ? "lines" : "capsules";
  context.print(
      {{"ms_per_frame", r.msPerFrame},
       {"frames_per_s", 1000.0 / r.msPerFrame},
       {"fill_ms", r.fillMs},
       {"cpu_ms_per_frame", r.cpuMsPerFrame},
       {"motions", spec.motions},
       {"frames", spec.frames},
       {"joints", r.joints},
       {"detail", o.detail},
       {"drawn_as", drawn},
       {"width", spec.width},
       {"height", spec.height},
       {"reference_ms_per_frame", r.referenceMsPerFrame},
       {"reference_frames", r.referenceFrames},
       {"ratio", ratio}},
      fmt::format("{} skeletons of {} joints as {}, {}x{}: {:.1f} ms a frame, {:.1f} "
                  "frames/s ({:.1f} ms before OpenGL, {:.1f} ms of processor time)\n"
                  "one full mesh built anew: {:.1f} ms a frame, {:.1f} times as long",
                  spec.motions, r.joints, drawn, spec.width, spec.height, r.msPerFrame,
                  1000.0 / r.msPerFrame, r.fillMs, r.cpuMsPerFrame, r.referenceMsPerFrame, ratio));
}

}  // namespace

void addBenchCommand(CLI::App& app, Context& context) {
  auto o = std::make_shared<Options>();
  auto* bench = app.add_subcommand("bench", "Measure speed on this machine");
  bench->require_subcommand(1);
  addModelBenchCommands(*bench, context);
  addTrainBenchCommand(*bench, context);
  auto* render = addCommand(*bench, context, "render", "How fast many skeletons are drawn",
                            "marey bench render --motions 1000 --detail lines",
                            [o, &context] { runRender(*o, context); });
  render->add_option("--motions", o->render.motions, "Skeletons, procedural walkers")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  render->add_option("--frames", o->render.frames, "Frames to draw")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  render->add_option("--detail", o->detail, "How bodies are drawn")
      ->check(CLI::IsMember({"auto", "capsules", "lines"}))
      ->capture_default_str();
  render->add_option("--size", o->size, "WIDTHxHEIGHT in pixels")->capture_default_str();
}

}  // namespace marey::cli
