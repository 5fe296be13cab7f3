// Experiment documents and the training of configurations: whatever the bytes, a value that is
// written and read back the same, or an Error.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "experiment/document.h"
#include "model/gradient/schedules.h"

// The tasks of documents, without the models that would do them.
namespace marey {

std::span<const Task> tasks() {
  static const std::array all{
      Task{.name = "predict",
           .options = {{.name = "seed_frames", .whole = true, .number = [](auto&, double) {}},
                       {.name = "seconds", .number = [](auto&, double) {}}}},
      Task{.name = "complete", .options = {{.name = "mask", .table = [](auto&, Matrix) {}}}}};
  return all;
}

const Task& taskNamed(const std::string& name) {
  for (const Task& task : tasks())
    if (task.name == name) return task;
  throw InputError({.path = "task"}, "a known one", name);
}

}  // namespace marey

namespace {

void readTraining(const marey::Json& value) {
  const auto config = marey::trainingConfigFromJson(value, "fuzz.json");
  const marey::Json written = marey::learningRateAt(config, 0, 1);
  if (marey::toJson(marey::trainingConfigFromJson(written, "back")) != written) std::abort();
  marey::learningRateAt(config, 0, 1);
}

void readDocument(const marey::Json& value) {
  const auto document = marey::experimentFromJson(value, "fuzz.json");
  const std::string written = marey::jsonText(marey::toJson(document));
  const auto back = marey::experimentFromJson(marey::parseJson(written, "back"), "back");
  if (marey::jsonText(marey::toJson(back)) != written) std::abort();
  marey::experimentHash(document);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const marey::Json value = marey::parseJson(text, "fuzz.json");
    if (value.is_object() && value.contains("training"))
      readTraining(value["training"]);
    else
      readDocument(value);
  } catch (const marey::Error&) {
  }
  return 0;
}
