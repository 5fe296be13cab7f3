// What the makers of a model say about it: the card and the advice in the model's file, or a card
// that lies beside it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/json.h"

namespace marey {

struct ModelAdvice {
  std::string card;                   ///< Markdown; empty: there is none
  std::filesystem::path cardFile;     ///< that the card was read from; empty: the model's own
  std::optional<double> temperature;  ///< recommended for sampling
};

/// Of a model's file, whose weights are not read. Without a card of its own it has NAME.card.md or
/// MODEL_CARD.md beside it. Throws InputError naming a recommendation that is not understood, and
/// FileError.
ModelAdvice modelAdvice(const std::filesystem::path& model);

/// Puts what is given into a model's metadata; other advice in it stays.
void storeAdvice(Json& metadata, const std::optional<std::string>& card,
                 const std::optional<double>& temperature);
/// What `model` advises goes into the metadata of what is made from it. Throws as modelAdvice.
void passAdviceOn(const std::filesystem::path& model, Json& metadata);

}  // namespace marey
