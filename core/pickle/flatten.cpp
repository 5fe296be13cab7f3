#include "pickle/flatten.h"

#include <algorithm>

#include "pickle/names.h"

namespace marey::pickle {
namespace {

using Kind = Value::Kind;

constexpr int kMaxDepth = 64;
constexpr size_t kMaxVisits = 500'000;
constexpr size_t kMaxPathLength = 4096;
constexpr size_t kMaxTextBytes = size_t{128} << 20;

bool isScalar(const Value& value) {
  return value.kind == Kind::None || value.kind == Kind::Bool || value.kind == Kind::Int ||
         value.kind == Kind::Float || value.kind == Kind::Text;
}

bool isOpaque(const Value& value) {
  return value.kind == Kind::Opaque || value.kind == Kind::NumpyType ||
         (value.kind == Kind::Global && isOpaqueName(value.text));
}

}  // namespace

Flattener::Flattener(TensorReader& reader, const TorchTensorFilter& filter, std::string origin)
    : m_reader(reader), m_filter(filter), m_origin(std::move(origin)) {}

Place Flattener::place(const std::string& path) const {
  return {.path = m_origin, .item = "value '" + path.substr(0, 200) + "'"};
}

TorchCheckpoint Flattener::flatten(const Value& root) {
  visit(root, {}, 0);
  TorchCheckpoint out;
  out.tensors = std::move(m_tensors);
  out.opaque = std::move(m_opaque);
  out.skipped = std::move(m_skipped);
  // Appended to the underlying vector: setting keys one by one would search it every time.
  auto& object = out.scalars.get_ref<Json::object_t&>();
  for (auto& [path, value] : m_scalars) object.emplace_back(path, std::move(value));
  return out;
}

void Flattener::chargeVisits(size_t count, const std::string& path) {
  m_visits += count;
  if (m_visits > kMaxVisits)
    throwInput(place(path), fmt::format("at most {} values", kMaxVisits), "more");
}

void Flattener::chargeText(size_t bytes, const std::string& path) {
  m_textBytes += bytes;
  if (m_textBytes > kMaxTextBytes)
    throwInput(place(path), fmt::format("at most {} bytes of text", kMaxTextBytes), "more");
}

std::string Flattener::child(const std::string& path, const std::string& key) {
  const size_t length = path.size() + key.size() + 1;
  if (length > kMaxPathLength)
    throwInput(place(path), fmt::format("paths of at most {} bytes", kMaxPathLength), "{}", length);
  chargeText(length, path);
  return path.empty() ? key : path + "/" + key;
}

Json Flattener::scalar(const Value& value, const std::string& path) {
  switch (value.kind) {
    case Kind::Bool:
      return value.integer != 0;
    case Kind::Int:
      return value.integer;
    case Kind::Float:
      return value.real;
    case Kind::Text:
      chargeText(value.text.size(), path);
      return value.text;
    default:
      return nullptr;
  }
}

std::string Flattener::keyText(const Value& key, const std::string& path) {
  if (isOpaque(key)) {
    chargeText(key.text.size(), path);
    return key.text;
  }
  if (key.kind == Kind::Tuple && std::all_of(key.items.begin(), key.items.end(),
                                             [](const Value* item) { return isScalar(*item); })) {
    std::string out;
    for (const Value* item : key.items) {
      out += (out.empty() ? "(" : ", ") + keyText(*item, path);
      chargeText(out.size(), path);
    }
    return out + ")";
  }
  if (!isScalar(key)) throw InputError(place(path), "text or a number as key", describe(key.kind));
  const Json value = scalar(key, path);
  return value.is_string() ? value.get<std::string>() : value.dump();
}

void Flattener::visit(const Value& value, const std::string& path, int depth) {
  if (depth > kMaxDepth)
    throwInput(place(path), fmt::format("nesting of at most {} levels", kMaxDepth), "more");
  chargeVisits(1, path);
  if (value.kind == Kind::Dict) return visitDict(value, path, depth);
  if (value.kind == Kind::List || value.kind == Kind::Tuple) return visitList(value, path, depth);
  if (value.kind == Kind::Bytes || value.kind == Kind::BigInt) return;
  if (!isScalar(value) && value.kind != Kind::Tensor && !isOpaque(value))
    throw InputError(place(path), "a tensor, container, number or text", describe(value.kind));
  if (!m_seen.insert(path).second) throw InputError(place(path), "one value of this path", "two");
  if (value.kind == Kind::Tensor)
    addTensor(*value.view, path);
  else if (isOpaque(value))
    m_opaque.emplace(path, value.text);
  else
    m_scalars.emplace(path, scalar(value, path));
}

void Flattener::visitDict(const Value& dict, const std::string& path, int depth) {
  chargeVisits(dict.items.size() / 2, path);
  std::map<std::string, const Value*> last;  // a key set twice holds its last value
  for (size_t i = 0; i + 1 < dict.items.size(); i += 2)
    last[keyText(*dict.items[i], path)] = dict.items[i + 1];
  for (const auto& [key, value] : last) visit(*value, child(path, key), depth + 1);
}

void Flattener::visitList(const Value& list, const std::string& path, int depth) {
  const bool plain = std::all_of(list.items.begin(), list.items.end(),
                                 [](const Value* item) { return isScalar(*item); });
  if (!plain) {
    for (size_t i = 0; i < list.items.size(); ++i)
      visit(*list.items[i], child(path, std::to_string(i)), depth + 1);
    return;
  }
  chargeVisits(list.items.size(), path);
  Json values = Json::array();
  for (const Value* item : list.items) values.push_back(scalar(*item, path));
  if (!m_seen.insert(path).second) throw InputError(place(path), "one value of this path", "two");
  m_scalars.emplace(path, std::move(values));
}

void Flattener::addTensor(const View& view, const std::string& path) {
  if (!m_filter || m_filter(path)) {
    m_tensors.emplace(path, m_reader.read(view, path));
    return;
  }
  m_reader.check(view, path);
  m_skipped.push_back(path);
}

}  // namespace marey::pickle
