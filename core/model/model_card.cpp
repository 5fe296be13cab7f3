#include "model/model_card.h"

#include "base/atomic_file.h"
#include "base/tensor_metadata.h"

namespace marey {
namespace {
namespace fs = std::filesystem;

constexpr size_t kLongestCard = size_t{1} << 20;

/// Of the file alone.
ModelAdvice ownAdvice(const fs::path& model) {
  const Json metadata = readTensorMetadata(model);
  JsonReader reader(metadata, model.string());
  ModelAdvice out;
  out.card = reader.optional<std::string>("card", "");
  if (!reader.has("recommended")) return out;
  JsonReader options = reader.object("recommended");
  if (options.has("temperature")) {
    out.temperature = options.required<double>("temperature");
    if (!(*out.temperature >= 0.0))
      throwInput(options.place("temperature"), "at least 0", "{}", *out.temperature);
  }
  options.finish();
  return out;
}

}  // namespace

ModelAdvice modelAdvice(const fs::path& model) {
  ModelAdvice out = ownAdvice(model);
  if (!out.card.empty()) return out;
  fs::path named = model;
  named.replace_extension(".card.md");
  for (const fs::path& file : {named, model.parent_path() / "MODEL_CARD.md"}) {
    std::error_code none;
    if (!fs::is_regular_file(file, none)) continue;
    out.card = readFile(file, kLongestCard);
    out.cardFile = file;
    break;
  }
  return out;
}

void storeAdvice(Json& metadata, const std::optional<std::string>& card,
                 const std::optional<double>& temperature) {
  if (card) metadata["card"] = *card;
  if (temperature) metadata["recommended"] = {{"temperature", *temperature}};
}

void passAdviceOn(const fs::path& model, Json& metadata) {
  const ModelAdvice own = ownAdvice(model);
  if (!own.card.empty()) storeAdvice(metadata, own.card, {});
  storeAdvice(metadata, {}, own.temperature);
}

}  // namespace marey
