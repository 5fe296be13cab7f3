#include "pickle/machine.h"

#include <algorithm>
#include <cstring>

#include "pickle/names.h"
#include "pickle/utf8.h"

namespace marey::pickle {
namespace {

constexpr size_t kMaxValues = 2'000'000;
constexpr size_t kMaxNameLength = 200;

using Kind = Value::Kind;

}  // namespace

const char* describe(Kind kind) {
  switch (kind) {
    case Kind::None:
      return "None";
    case Kind::Bool:
      return "a truth value";
    case Kind::Int:
      return "an integer";
    case Kind::BigInt:
      return "an integer of more than 64 bits";
    case Kind::Float:
      return "a number";
    case Kind::Text:
      return "text";
    case Kind::Bytes:
      return "bytes";
    case Kind::List:
      return "a list";
    case Kind::Tuple:
      return "a tuple";
    case Kind::Dict:
      return "a dictionary";
    case Kind::Global:
      return "a name";
    case Kind::Storage:
      return "a storage";
    case Kind::Tensor:
      return "a tensor";
    case Kind::NumpyType:
      return "a numpy type";
    case Kind::Opaque:
      break;
  }
  return "a value of training state";
}

Value* Arena::make(Kind kind, const Place& place) {
  if (m_values.size() >= kMaxValues)
    throwInput(place, fmt::format("at most {} values", kMaxValues), "more");
  Value& value = m_values.emplace_back();
  value.kind = kind;
  return &value;
}

Machine::Machine(std::string_view bytes, size_t start, std::string origin, Arena& arena)
    : m_bytes(bytes),
      m_position(start),
      m_opcodeAt(start),
      m_origin(std::move(origin)),
      m_arena(arena) {}

Place Machine::place() const {
  return {.path = m_origin, .item = fmt::format("pickle byte {}", m_opcodeAt)};
}

void Machine::refuse(const std::string& expected, const std::string& found) const {
  throw InputError(place(), expected, found);
}

Value* Machine::run() {
  constexpr uint8_t kProtocol = 0x80;
  constexpr uint8_t kFrame = 0x95;
  while (true) {
    m_opcodeAt = m_position;
    const auto op = static_cast<uint8_t>(take(1)[0]);
    if (op == '.') break;
    if (op == kProtocol) {
      const uint64_t version = takeUnsigned(1);
      if (version > 5) refuse("a pickle protocol up to 5", std::to_string(version));
    } else if (op == kFrame) {
      take(8);
    } else if (!number(op) && !text(op) && !sequence(op) && !dictionary(op) && !memo(op) &&
               !object(op)) {
      refuse("an opcode of a PyTorch checkpoint", fmt::format("opcode 0x{:02x}", op));
    }
  }
  return pop();
}

std::string_view Machine::take(uint64_t count) {
  if (count > m_bytes.size() - m_position)
    refuse(fmt::format("{} more bytes", count),
           fmt::format("{} (is the file cut?)", m_bytes.size() - m_position));
  const auto out = m_bytes.substr(m_position, count);
  m_position += count;
  return out;
}

std::string_view Machine::takeLine() {
  const size_t end = m_bytes.substr(0, std::min(m_bytes.size(), m_position + kMaxNameLength))
                         .find('\n', m_position);
  if (end == std::string_view::npos) refuse("a line of text", "no end of line");
  const auto out = take(end - m_position);
  ++m_position;
  return out;
}

uint64_t Machine::takeUnsigned(int byteCount) {
  uint64_t out = 0;
  const auto bytes = take(static_cast<uint64_t>(byteCount));
  std::memcpy(&out, bytes.data(), bytes.size());  // little-endian, as this machine is
  return out;
}

void Machine::push(Value* value) {
  m_stack.push_back(value);
}

Value* Machine::top() {
  const size_t floor = m_marks.empty() ? 0 : m_marks.back();
  if (m_stack.size() <= floor) refuse("a value on the stack", "none");
  return m_stack.back();
}

Value* Machine::pop() {
  Value* out = top();
  m_stack.pop_back();
  return out;
}

std::vector<Value*> Machine::popToMark() {
  if (m_marks.empty()) refuse("a mark on the stack", "none");
  const auto from = m_stack.begin() + static_cast<std::ptrdiff_t>(m_marks.back());
  std::vector<Value*> out(from, m_stack.end());
  m_stack.erase(from, m_stack.end());
  m_marks.pop_back();
  return out;
}

void Machine::pushTuple(size_t count) {
  Value* out = make(Kind::Tuple);
  out->items.resize(count);
  while (count-- > 0) out->items[count] = pop();
  push(out);
}

void Machine::appendItems(Value* list, const std::vector<Value*>& items) {
  if (list->kind == Kind::Opaque) return;
  if (list->kind != Kind::List) refuse("a list to append to", describe(list->kind));
  list->items.insert(list->items.end(), items.begin(), items.end());
}

bool Machine::sequence(uint8_t op) {
  switch (op) {
    case '(':
      m_marks.push_back(m_stack.size());
      return true;
    case '0':
      pop();
      return true;
    case '1':
      popToMark();
      return true;
    case '2':
      push(top());
      return true;
    case ')':
      pushTuple(0);
      return true;
    case 0x85:
      pushTuple(1);
      return true;
    case 0x86:
      pushTuple(2);
      return true;
    case 0x87:
      pushTuple(3);
      return true;
    case ']':
    case 0x8f:
      push(make(Kind::List));
      return true;  // 0x8f: a set
    case 't':
    case 'l':
    case 0x91: {  // 0x91: a frozen set
      Value* out = make(op == 'l' ? Kind::List : Kind::Tuple);
      out->items = popToMark();
      push(out);
      return true;
    }
    case 'a': {
      Value* item = pop();
      appendItems(top(), {item});
      return true;
    }
    case 'e':
    case 0x90: {  // 0x90: items of a set
      const auto items = popToMark();
      appendItems(top(), items);
      return true;
    }
    default:
      return false;
  }
}

void Machine::setItems(Value* dict, const std::vector<Value*>& items) {
  if (dict->kind == Kind::Opaque) return;
  if (dict->kind != Kind::Dict) refuse("a dictionary to fill", describe(dict->kind));
  if (items.size() % 2 != 0) refuse("pairs of keys and values", "a key without a value");
  dict->items.insert(dict->items.end(), items.begin(), items.end());
}

bool Machine::dictionary(uint8_t op) {
  switch (op) {
    case '}':
      push(make(Kind::Dict));
      return true;
    case 'd': {
      const auto items = popToMark();
      push(make(Kind::Dict));
      setItems(top(), items);
      return true;
    }
    case 's': {
      Value* value = pop();
      Value* key = pop();
      setItems(top(), {key, value});
      return true;
    }
    case 'u': {
      const auto items = popToMark();
      setItems(top(), items);
      return true;
    }
    default:
      return false;
  }
}

bool Machine::memo(uint8_t op) {
  const auto get = [this](uint64_t index) {
    const auto found = m_memo.find(index);
    if (found == m_memo.end()) refuse("a value stored before", fmt::format("memo {}", index));
    push(found->second);
  };
  switch (op) {
    case 'q':
      m_memo[takeUnsigned(1)] = top();
      return true;
    case 'r':
      m_memo[takeUnsigned(4)] = top();
      return true;
    case 0x94: {
      const size_t index = m_memo.size();
      m_memo[index] = top();
      return true;
    }
    case 'h':
      get(takeUnsigned(1));
      return true;
    case 'j':
      get(takeUnsigned(4));
      return true;
    default:
      return false;
  }
}

void Machine::pushGlobal(std::string_view module, std::string_view name) {
  const std::string qualified = fmt::format("{}.{}", module, name);
  if (!isAllowed(qualified))
    refuse("names of tensors and containers only",
           fmt::format("'{}', which is refused (nothing was run); {}", printable(qualified),
                       adviceFor(qualified)));
  Value* out = make(Kind::Global);
  out->text = qualified;
  push(out);
}

bool Machine::object(uint8_t op) {
  switch (op) {
    case 'i':  // INST: names and calls in one
    case 'c': {
      const auto module = takeLine();
      const auto name = takeLine();
      pushGlobal(module, name);
      if (op == 'i') refuse("a call of protocol 2 or later", "opcode INST");
      return true;
    }
    case 0x93: {
      const Value* name = pop();
      const Value* module = pop();
      if (name->kind != Kind::Text || module->kind != Kind::Text)
        refuse("a name as text", describe(name->kind));
      pushGlobal(module->text, name->text);
      return true;
    }
    case 'R':
    case 0x81: {  // 0x81: NEWOBJ
      const Value* arguments = pop();
      const Value* callee = pop();
      push(call(*callee, *arguments, m_arena, place()));
      return true;
    }
    case 0x92: {  // NEWOBJ_EX: with named arguments, which no allowed name needs
      pop();
      const Value* arguments = pop();
      const Value* callee = pop();
      push(call(*callee, *arguments, m_arena, place()));
      return true;
    }
    case 'b': {
      const Value* state = pop();
      build(*top(), *state, place());
      return true;
    }
    case 'Q':
      push(persistent(*pop(), m_arena, place()));
      return true;
    default:
      return false;
  }
}

}  // namespace marey::pickle
