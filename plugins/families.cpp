#include "families.h"

#include <array>

#include "moglow/family.h"
#include "rnn/family.h"
#include "vae/family.h"

namespace marey {

std::span<const ModelFamily> modelFamilies() {
  static const std::array families{moglow::family(), rnn::family(), vae::family()};
  return families;
}

}  // namespace marey
