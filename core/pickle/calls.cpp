// The names a PyTorch checkpoint may mention, and what they stand for.
#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "pickle/machine.h"
#include "pickle/names.h"
#include "pickle/utf8.h"

namespace marey::pickle {
namespace {

using Kind = Value::Kind;

struct StorageType {
  std::string_view name;
  Element element;
};
constexpr std::array<StorageType, 10> kStorageTypes{
    {{"torch.FloatStorage", {DType::F32}},
     {"torch.DoubleStorage", {DType::F64}},
     {"torch.HalfStorage", {DType::F16}},
     {"torch.BFloat16Storage", {DType::F32, Element::Form::BFloat16}},
     {"torch.LongStorage", {DType::I64}},
     {"torch.IntStorage", {DType::I32}},
     {"torch.ShortStorage", {DType::I32, Element::Form::Int16}},
     {"torch.CharStorage", {DType::I32, Element::Form::Int8}},
     {"torch.ByteStorage", {DType::U8}},
     {"torch.BoolStorage", {DType::U8}}}};

using Function = Value* (*)(const std::vector<Value*>& arguments, Arena& arena, const Place& place);

struct Callable {
  std::string_view name;
  size_t minArguments;
  size_t maxArguments;
  Function function;
};

const Value& ofKind(const Value* value, Kind kind, const Place& place) {
  if (value->kind != kind) throw InputError(place, describe(kind), describe(value->kind));
  return *value;
}

const std::vector<Value*>& itemsOf(const Value* value, const Place& place) {
  if (value->kind != Kind::List && value->kind != Kind::Tuple)
    throw InputError(place, "a list or tuple", describe(value->kind));
  return value->items;
}

std::vector<int64_t> sizesOf(const Value* value, const Place& place) {
  std::vector<int64_t> out;
  for (const Value* item : itemsOf(value, place)) {
    const int64_t size = ofKind(item, Kind::Int, place).integer;
    if (size < 0) throw InputError(place, "sizes of 0 or more", std::to_string(size));
    out.push_back(size);
  }
  return out;
}

Value* orderedDict(const std::vector<Value*>& arguments, Arena& arena, const Place& place) {
  Value* out = arena.make(Kind::Dict, place);
  if (arguments.empty()) return out;
  for (const Value* pair : itemsOf(arguments[0], place)) {
    const auto& both = itemsOf(pair, place);
    if (both.size() != 2) throwInput(place, "pairs of keys and values", "{} items", both.size());
    out->items.insert(out->items.end(), both.begin(), both.end());
  }
  return out;
}

Value* size(const std::vector<Value*>& arguments, Arena& arena, const Place& place) {
  Value* out = arena.make(Kind::Tuple, place);
  out->items = itemsOf(arguments[0], place);
  return out;
}

/// (storage, offset, size, stride[, requires_grad, backward_hooks[, metadata]])
Value* tensor(const std::vector<Value*>& arguments, Arena& arena, const Place& place) {
  const int64_t offset = ofKind(arguments[1], Kind::Int, place).integer;
  if (offset < 0) throw InputError(place, "an offset of 0 or more", std::to_string(offset));
  auto view = std::make_unique<View>();
  view->storage = ofKind(arguments[0], Kind::Storage, place).storage.get();
  view->offset = static_cast<uint64_t>(offset);
  view->shape = sizesOf(arguments[2], place);
  view->strides = sizesOf(arguments[3], place);
  if (view->shape.size() != view->strides.size())
    throwInput(place, fmt::format("{} strides", view->shape.size()), "{}", view->strides.size());
  Value* out = arena.make(Kind::Tensor, place);
  out->view = std::move(view);
  return out;
}

/// (tensor, requires_grad, backward_hooks)
Value* parameter(const std::vector<Value*>& arguments, Arena&, const Place& place) {
  ofKind(arguments[0], Kind::Tensor, place);
  return arguments[0];
}

/// Bytes, or the text that stands for them in protocol 2.
std::string bytesOf(const Value* value, const Place& place) {
  if (value->kind == Kind::Bytes) return value->text;
  const auto bytes = latin1FromUtf8(ofKind(value, Kind::Text, place).text);
  if (!bytes) throw InputError(place, "bytes as Latin-1 text", "other characters");
  return *bytes;
}

/// _codecs.encode(text, 'latin1'): how protocol 2 writes bytes.
Value* encode(const std::vector<Value*>& arguments, Arena& arena, const Place& place) {
  const std::string& encoding = ofKind(arguments[1], Kind::Text, place).text;
  if (encoding != "latin1") throw InputError(place, "encoding latin1", printable(encoding));
  Value* out = arena.make(Kind::Bytes, place);
  out->text = bytesOf(arguments[0], place);
  return out;
}

Value* numpyType(const std::vector<Value*>& arguments, Arena& arena, const Place& place) {
  Value* out = arena.make(Kind::NumpyType, place);
  out->text = ofKind(arguments[0], Kind::Text, place).text;
  return out;
}

Value* opaque(const std::string& className, Arena& arena, const Place& place) {
  Value* out = arena.make(Kind::Opaque, place);
  out->text = className;
  return out;
}

template <typename T>
std::optional<T> as(std::string_view code, std::string_view wanted, const std::string& bytes) {
  if (code != wanted || bytes.size() != sizeof(T)) return std::nullopt;
  T out;
  std::memcpy(&out, bytes.data(), sizeof(T));
  return out;
}

/// numpy.core.multiarray.scalar(dtype, bytes)
Value* numpyScalar(const std::vector<Value*>& arguments, Arena& arena, const Place& place) {
  const Value& type = ofKind(arguments[0], Kind::NumpyType, place);
  const std::string code = type.integer == 0 ? type.text : "";
  const std::string bytes = bytesOf(arguments[1], place);
  const auto made = [&](Kind kind, double real, int64_t integer) {
    Value* out = arena.make(kind, place);
    out->real = real;
    out->integer = integer;
    return out;
  };
  if (const auto value = as<double>(code, "f8", bytes)) return made(Kind::Float, *value, 0);
  if (const auto value = as<float>(code, "f4", bytes)) return made(Kind::Float, *value, 0);
  if (const auto value = as<int64_t>(code, "i8", bytes)) return made(Kind::Int, 0, *value);
  if (const auto value = as<int32_t>(code, "i4", bytes)) return made(Kind::Int, 0, *value);
  if (const auto value = as<uint8_t>(code, "b1", bytes)) return made(Kind::Bool, 0, *value != 0);
  return opaque("numpy." + printable(type.text), arena, place);
}

/// A class whose constructor takes a dictionary, a function for what is missing, or nothing.
Value* dictionaryLike(const Value& arguments, Arena& arena, const Place& place) {
  Value* out = arena.make(Kind::Dict, place);
  for (const Value* argument : itemsOf(&arguments, place))
    if (argument->kind == Kind::Dict) out->items = argument->items;
  return out;
}

/// The class that a value has: helpers that rebuild one name it in their arguments.
std::string classOf(const std::string& callee, const Value& arguments) {
  const auto& items = arguments.items;
  const bool names = !items.empty() && items[0]->kind == Kind::Global &&
                     (callee.find("._reconstruct") != std::string::npos);
  return names ? items[0]->text : callee;
}

constexpr std::array<Callable, 9> kCallables{{
    {"collections.OrderedDict", 0, 1, orderedDict},
    {"torch.Size", 1, 1, size},
    {"torch._utils._rebuild_tensor", 4, 4, tensor},
    {"torch._utils._rebuild_tensor_v2", 6, 7, tensor},
    {"torch._utils._rebuild_parameter", 3, 3, parameter},
    {"_codecs.encode", 2, 2, encode},
    {"numpy.dtype", 1, 3, numpyType},
    {"numpy.core.multiarray.scalar", 2, 2, numpyScalar},
    {"numpy._core.multiarray.scalar", 2, 2, numpyScalar},
}};

template <typename Table>
auto find(const Table& table, std::string_view name) {
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const auto& row) { return row.name == name; });
  return found == table.end() ? nullptr : &*found;
}

}  // namespace

bool isAllowed(std::string_view qualifiedName) {
  return find(kCallables, qualifiedName) != nullptr ||
         find(kStorageTypes, qualifiedName) != nullptr || isDictionaryName(qualifiedName) ||
         isOpaqueName(qualifiedName);
}

Value* call(const Value& callee, const Value& arguments, Arena& arena, const Place& place) {
  const std::string& name = ofKind(&callee, Kind::Global, place).text;
  if (isDictionaryName(name)) return dictionaryLike(arguments, arena, place);
  if (isOpaqueName(name)) return opaque(classOf(name, arguments), arena, place);
  const Callable* callable = find(kCallables, name);
  if (callable == nullptr)
    throw InputError(place, "a call that rebuilds a tensor or container", "a call of " + name);
  const auto& items = ofKind(&arguments, Kind::Tuple, place).items;
  if (items.size() < callable->minArguments || items.size() > callable->maxArguments)
    throwInput(place,
               fmt::format("{} to {} arguments of {}", callable->minArguments,
                           callable->maxArguments, name),
               "{}", items.size());
  return callable->function(items, arena, place);
}

Value* persistent(const Value& id, Arena& arena, const Place& place) {
  const auto& items = ofKind(&id, Kind::Tuple, place).items;
  if (items.size() < 5 || items.size() > 6 || items[0]->kind != Kind::Text ||
      items[0]->text != "storage")
    throw InputError(place, "a reference to a storage", "another reference");
  const std::string& typeName = ofKind(items[1], Kind::Global, place).text;
  const StorageType* type = find(kStorageTypes, typeName);
  if (type == nullptr) throw InputError(place, "a storage type", typeName);
  const int64_t count = ofKind(items[4], Kind::Int, place).integer;
  if (count < 0) throw InputError(place, "a size of 0 or more", std::to_string(count));
  if (items.size() == 6 && items[5]->kind != Kind::None)
    throw InputError(place, "a whole storage", "a window on another storage");
  Value* out = arena.make(Kind::Storage, place);
  out->storage = std::make_unique<Storage>(Storage{.element = type->element,
                                                   .key = ofKind(items[2], Kind::Text, place).text,
                                                   .count = static_cast<uint64_t>(count)});
  return out;
}

void build(Value& target, const Value& state, const Place& place) {
  if (target.kind == Kind::Dict || target.kind == Kind::Opaque) return;
  if (target.kind != Kind::NumpyType)
    throwInput(place, "state of dictionaries and training state only", "state of {}",
               describe(target.kind));
  const auto& items = itemsOf(&state, place);
  const bool big = items.size() > 1 && items[1]->kind == Kind::Text && items[1]->text == ">";
  target.integer = big ? 1 : 0;
}

}  // namespace marey::pickle
