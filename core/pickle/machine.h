// A stack machine for Python pickles (protocols 2 to 4) that builds plain values and calls
// nothing. Private to the PyTorch reader.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/error.h"
#include "base/tensor_file.h"

namespace marey::pickle {

/// How a storage keeps its values. Types that Tensor lacks are widened to one that holds them.
struct Element {
  enum class Form { Plain, BFloat16, Int8, Int16 };
  DType dtype = DType::F32;  ///< as it is read
  Form form = Form::Plain;

  size_t bytes() const {  ///< of one value in the file
    return form == Form::Plain ? byteSize(dtype) : form == Form::Int8 ? 1 : 2;
  }
};

/// The values of one storage of the file, named by `key`.
struct Storage {
  Element element;
  std::string key;
  uint64_t count = 0;
};

/// A strided window on a storage, in elements. Bounds are checked where it is copied out.
struct View {
  const Storage* storage = nullptr;
  uint64_t offset = 0;
  std::vector<int64_t> shape;
  std::vector<int64_t> strides;
};

struct Value {
  enum class Kind {
    None,
    Bool,
    Int,
    BigInt,  ///< more than 64 bits; `text` holds the little-endian bytes
    Float,
    Text,
    Bytes,
    List,
    Tuple,
    Dict,    ///< `items` alternates keys and values
    Global,  ///< an allowed name, "module.name" in `text`
    Storage,
    Tensor,
    NumpyType,  ///< its code ("f8") in `text`; `integer` is 1 for big-endian
    Opaque,     ///< a value of training state: the name of its class in `text`
  };
  Kind kind = Kind::None;
  int64_t integer = 0;
  double real = 0.0;
  std::string text;
  std::vector<Value*> items;
  std::unique_ptr<Storage> storage;
  std::unique_ptr<View> view;
};

/// For messages: "a list", "an integer", ...
const char* describe(Value::Kind kind);

/// Owns every value of a file, so that cycles do not leak and deep nesting does not recurse in
/// destructors.
class Arena {
 public:
  /// Throws InputError beyond two million values.
  Value* make(Value::Kind kind, const Place& place);
  const std::deque<Value>& values() const { return m_values; }

 private:
  std::deque<Value> m_values;
};

/// Reads one pickle of `bytes`, starting at `start`.
class Machine {
 public:
  Machine(std::string_view bytes, size_t start, std::string origin, Arena& arena);

  /// The pickled object. Throws InputError. Call once.
  Value* run();
  /// The first byte after the pickle, once run.
  size_t position() const { return m_position; }

 private:
  // Each returns false when the opcode is none of its own.
  bool number(uint8_t op);
  bool text(uint8_t op);
  bool sequence(uint8_t op);
  bool dictionary(uint8_t op);
  bool memo(uint8_t op);
  bool object(uint8_t op);

  std::string_view take(uint64_t count);
  std::string_view takeLine();
  uint64_t takeUnsigned(int byteCount);
  void push(Value* value);
  Value* pop();
  Value* top();
  /// Everything above the last mark, which is removed.
  std::vector<Value*> popToMark();
  Value* make(Value::Kind kind) { return m_arena.make(kind, place()); }
  void pushTuple(size_t count);
  void pushLong(std::string_view littleEndian);
  void pushText(std::string_view utf8);
  void pushLatin1(std::string_view bytes);
  void pushBytes(std::string_view bytes);
  void appendItems(Value* list, const std::vector<Value*>& items);
  void setItems(Value* dict, const std::vector<Value*>& items);
  void pushGlobal(std::string_view module, std::string_view name);
  [[noreturn]] void refuse(const std::string& expected, const std::string& found) const;
  Place place() const;

  std::string_view m_bytes;
  size_t m_position;
  size_t m_opcodeAt;
  std::string m_origin;
  Arena& m_arena;
  std::vector<Value*> m_stack;
  std::vector<size_t> m_marks;
  std::unordered_map<uint64_t, Value*> m_memo;
};

// The allow-list (pickle_calls.cpp). Each throws InputError.

/// Whether "module.name" may be mentioned at all.
bool isAllowed(std::string_view qualifiedName);
/// What calling an allowed name with a tuple of arguments gives; runs nothing.
Value* call(const Value& callee, const Value& arguments, Arena& arena, const Place& place);
/// What a persistent id stands for: ('storage', type, key, location, count[, None]).
Value* persistent(const Value& id, Arena& arena, const Place& place);
/// Takes the state that is set on a value. It is then forgotten, but for the byte order of numpy
/// types: dictionaries carry attributes that no tensor needs.
void build(Value& target, const Value& state, const Place& place);

}  // namespace marey::pickle
