#include "families.h"

#include <array>

#include "moglow/family.h"

namespace marey {

std::span<const ModelFamily> modelFamilies() {
  static const std::array<ModelFamily, 1> families{moglow::family()};
  return families;
}

}  // namespace marey
