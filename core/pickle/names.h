// Which names a checkpoint may mention besides those that make tensors. Private to the PyTorch
// reader.
#pragma once

#include <string>
#include <string_view>

namespace marey::pickle {

/// Classes and types of training state (paths, dates, devices, NumPy arrays, schedulers, settings):
/// such values are kept as the name of their class; nothing of theirs is made or run.
bool isOpaqueName(std::string_view qualifiedName);
/// Classes that are dictionaries, whatever else they do.
bool isDictionaryName(std::string_view qualifiedName);
/// What to do about a name that is refused.
std::string adviceFor(std::string_view qualifiedName);

}  // namespace marey::pickle
