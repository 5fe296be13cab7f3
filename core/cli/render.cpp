#include <algorithm>
#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "cli/command.h"
#include "cli/readers.h"
#include "render/film/film.h"

namespace marey::cli {
namespace fs = std::filesystem;
namespace {

struct RenderOptions {
  std::vector<std::string> inputs, natural;
  std::string out, size = "1280x720", camera = "three-quarter", title;
  double fps = 30.0, strobeS = 0.0;
  bool orthographic = false, follow = false;
  io::ReadOptions read;
};

struct Size {
  int width = 0, height = 0;
};

Size parseSize(const std::string& text) {
  Size size;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &size.width, &size.height, &rest) != 2 ||
      size.width < 32 || size.height < 32 || size.width > 8192 || size.height > 8192) {
    throw UsageError(
        fmt::format("--size: expected WIDTHxHEIGHT from 32x32 to 8192x8192, found '{}'", text));
  }
  return size;
}

render::View parseView(const std::string& text) {
  if (text == "side") return render::View::Side;
  if (text == "top") return render::View::Top;
  return render::View::ThreeQuarter;
}

/// Natural clips near-black, the others in one colour beside them, else in a colour each.
render::Shot shotOf(std::vector<Clip> natural, std::vector<Clip> clips,
                    const RenderOptions& options) {
  std::vector<render::SceneMotion> motions;
  const auto add = [&](Clip& clip, const std::string& system, const render::Colour& colour) {
    motions.push_back(
        {.clip = std::make_shared<const Clip>(std::move(clip)), .colour = colour, .label = system});
  };
  for (Clip& clip : natural) add(clip, "natural", render::naturalColour());
  const bool alone = clips.size() == 1;
  for (size_t i = 0; i < clips.size(); ++i) {
    const std::string name = clips[i].name;
    if (natural.empty())
      add(clips[i], name, alone ? render::naturalColour() : render::colourOf(static_cast<int>(i)));
    else
      add(clips[i], alone ? name : "samples", render::colourOf(0));
  }
  render::Shot shot = render::shotOfMotions(std::move(motions));
  shot.caption.title = options.title;
  shot.view = parseView(options.camera);
  shot.orthographic = options.orthographic;
  shot.follow = options.follow;
  return shot;
}

render::Recipe recipeOf(const Context& context, const std::vector<fs::path>& files) {
  render::Recipe recipe = {{"marey", MAREY_VERSION}, {"command", context.commandLine}};
  std::string names;
  for (const fs::path& file : files) names += (names.empty() ? "" : ", ") + file.string();
  recipe.emplace_back("inputs", names);
  return recipe;
}

void checkKind(const RenderOptions& options) {
  if (render::videoKind(options.out)) return;
  if (fs::path(options.out).extension() != ".png")
    throw UsageError(fmt::format(
        "--out: expected a file ending in .mp4, .webm, .gif or .png, found '{}'", options.out));
  if (options.follow)
    throw UsageError("--follow: only a video or numbered pictures have a moving camera");
}

void runRender(const Context& context, const RenderOptions& options) {
  checkKind(options);
  const Size size = parseSize(options.size);
  const io::Inputs inputs = io::findInputs(options.inputs);
  const io::Inputs natural =
      options.natural.empty() ? io::Inputs() : io::findInputs(options.natural);
  io::InputReport report(inputs);
  report.add(io::InputReport(natural));
  Progress progress = context.progress("rendering");
  Progress reading = progress.part(0.0, 0.1);
  const std::vector<Clip> naturalClips = readAll(natural, options.read, report, reading);
  const render::Shot shot =
      shotOf(naturalClips, readAll(inputs, options.read, report, reading), options);
  std::vector<fs::path> all = natural.paths();
  for (const fs::path& file : inputs.paths()) all.push_back(file);
  const render::Recipe recipe = recipeOf(context, all);
  const bool still = !render::videoKind(options.out);
  int frames = 1;
  if (still) {
    constexpr double usualS = 0.4;
    const auto plate = render::strobed(shot, options.strobeS > 0.0 ? options.strobeS : usualS);
    render::writePng(options.out, render::drawEnd(plate, size.width, size.height), recipe);
  } else {
    const render::VideoFormat format{
        .width = size.width, .height = size.height, .fps = options.fps};
    Progress drawing = progress.part(0.1, 1.0);
    const bool trail = options.strobeS > 0.0;
    frames = render::writeFilm(options.out, trail ? render::withTrail(shot, options.strobeS) : shot,
                               format, recipe, drawing);
  }
  progress.report(1.0);
  const double fps = still ? 0.0 : options.fps;
  Json result = {{"file", options.out}, {"frames", frames}, {"fps", fps}};
  report.addTo(result);
  tell(context, report);
  context.print(result, fmt::format("{}\n", options.out));
}

}  // namespace

void addRenderCommand(CLI::App& app, Context& context) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = addCommand(
      app, context, "render",
      "A video (.mp4, .webm, .gif, numbered .png) or one strobed picture (.png) of motions",
      "marey render samples/ --natural walk.bvh --out fan.png --strobe 0.5",
      [&context, options] { runRender(context, *options); });
  command->add_option("inputs", options->inputs, "motion files, folders or @LIST")->required();
  command->add_option("--natural", options->natural,
                      "motion to compare with: near-black, the others see-through over it");
  command
      ->add_option("--out", options->out,
                   "file ending in .mp4, .webm, .gif or .png; .png with {frame:04} in its name: a "
                   "picture per frame, numbered from 0")
      ->required();
  command->add_option("--fps", options->fps, "frames per second of a video, at most 50 in .gif")
      ->check(CLI::Range(1.0, 240.0))
      ->capture_default_str();
  command->add_option("--size", options->size, "pixels, even for .mp4 and .webm")
      ->capture_default_str();
  command->add_option("--camera", options->camera, "three-quarter, side or top")
      ->check(CLI::IsMember({"three-quarter", "side", "top"}))
      ->capture_default_str();
  command->add_flag("--ortho", options->orthographic,
                    "no perspective: lengths compare all over the picture");
  command->add_flag("--follow", options->follow, "the camera moves along with the figures");
  command
      ->add_option(
          "--strobe", options->strobeS,
          "seconds between figures of a picture (default 0.4); in a video, earlier figures stay")
      ->check(CLI::PositiveNumber);
  command->add_option("--title", options->title, "text at the top");
  addReadOptions(*command, options->read);
}

}  // namespace marey::cli
