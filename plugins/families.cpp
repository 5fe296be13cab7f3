#include "families.h"

#include <array>

#include "moglow/family.h"
#include "rnn/family.h"

namespace marey {

std::span<const ModelFamily> modelFamilies() {
  static const std::array families{moglow::family(), rnn::family()};
  return families;
}

}  // namespace marey
