#include "io/utf8_names.h"

#include <unordered_set>

#include "base/json.h"

namespace marey::io {

std::vector<std::string> utf8Names(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  // Names that need no change keep theirs, wherever they stand.
  std::unordered_set<std::string> taken;
  for (const std::string& name : names) {
    out.push_back(Json::parse(jsonText(name)).get<std::string>());
    if (out.back() == name) taken.insert(name);
  }
  for (size_t j = 0; j < out.size(); ++j) {
    if (out[j] == names[j]) continue;
    const std::string wanted = out[j];
    for (int n = 2; !taken.insert(out[j]).second; ++n) out[j] = fmt::format("{}_{}", wanted, n);
  }
  return out;
}

}  // namespace marey::io
