#include "io/dog_text.h"

#include "io/known_skeletons.h"
#include "io/normalise.h"
#include "io/plain_text.h"
#include "io/text.h"
#include "motion/skeleton_fit.h"

namespace marey::io {
namespace {

constexpr int kJoints = 27;
constexpr double kFps = 60.0;

void readRow(std::string_view row, const Place& place, std::vector<Vec3>& out) {
  int found = 0;
  Vec3 position;
  double value = 0.0;
  NumberResult result = NumberResult::Number;
  while ((result = takeNumber(row, value, true)) == NumberResult::Number) {
    position[found % 3] = static_cast<float>(value);
    if (++found % 3 == 0 && found <= kJoints * 3) out.push_back(position);
  }
  if (result == NumberResult::Bad)
    throw InputError(place, "a finite number", excerpt(row.substr(0, row.find(','))));
  if (found != kJoints * 3) throwInput(place, "81 numbers (27 joints)", "{}", found);
}

}  // namespace

int canReadDogText(std::string_view head) {
  const PlainText plain(head);
  LineReader lines(plain.text(), {});
  auto line = lines.nextFilled();
  while (line && isComment(trim(*line))) line = lines.nextFilled();
  if (!line) return 0;
  std::string_view row = *line;
  int numbers = 0;
  double value = 0.0;
  while (takeNumber(row, value, true) == NumberResult::Number) ++numbers;
  const bool commas = line->find(',') != std::string_view::npos;
  return commas && row.empty() && numbers == kJoints * 3 ? 80 : 0;
}

Clip parseDogText(std::string_view bytes, const std::string& origin, const ReadOptions& options) {
  const PlainText plain(bytes);
  LineReader lines(plain.text(), origin);
  Clip clip;
  clip.name = std::filesystem::path(origin).stem().string();
  clip.fps = kFps;
  clip.source.path = origin;
  clip.source.format = "dog-text";
  clip.source.fps = kFps;
  clip.source.notes = plain.notes();
  while (const auto line = lines.nextFilled())
    if (!isComment(trim(*line))) readRow(*line, lines.place(), clip.positions);
  if (clip.positions.empty()) throw InputError(lines.place(), "at least one frame", "zero frames");
  clip.skeleton = std::make_shared<const Skeleton>(dogSkeleton());
  clip.skeleton = withOffsetsFrom(clip);
  if (!options.fps) clip.source.notes.push_back("the format states no frame rate: 60 is its own");
  return normalised(std::move(clip), {.unit = unitByName("m"), .up = "y"}, options);
}

std::vector<Clip> readDogText(std::string_view bytes, const std::filesystem::path& path,
                              const ReadOptions& options) {
  return {parseDogText(bytes, path.string(), options)};
}

}  // namespace marey::io
