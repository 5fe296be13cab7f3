// The opcodes of the pickle machine that push numbers, text and bytes.
#include <bit>
#include <cstring>

#include "pickle/machine.h"
#include "pickle/utf8.h"

namespace marey::pickle {

using Kind = Value::Kind;

bool Machine::number(uint8_t op) {
  const auto integer = [this](int64_t value) {
    Value* out = make(Kind::Int);
    out->integer = value;
    push(out);
  };
  const auto truth = [this](bool value) {
    Value* out = make(Kind::Bool);
    out->integer = value ? 1 : 0;
    push(out);
  };
  switch (op) {
    case 'N':
      push(make(Kind::None));
      return true;
    case 0x88:
      truth(true);
      return true;
    case 0x89:
      truth(false);
      return true;
    case 'J':
      integer(static_cast<int32_t>(takeUnsigned(4)));
      return true;
    case 'K':
      integer(static_cast<int64_t>(takeUnsigned(1)));
      return true;
    case 'M':
      integer(static_cast<int64_t>(takeUnsigned(2)));
      return true;
    case 0x8a:
      pushLong(take(takeUnsigned(1)));
      return true;
    case 0x8b:
      pushLong(take(takeUnsigned(4)));
      return true;
    case 'G': {
      Value* out = make(Kind::Float);
      // Big-endian, alone among all numbers of the format.
      out->real = std::bit_cast<double>(__builtin_bswap64(takeUnsigned(8)));
      push(out);
      return true;
    }
    default:
      return false;
  }
}

void Machine::pushLong(std::string_view littleEndian) {
  if (littleEndian.size() > 8) {
    Value* out = make(Kind::BigInt);
    out->text = littleEndian;
    push(out);
    return;
  }
  uint64_t bits = 0;
  std::memcpy(&bits, littleEndian.data(), littleEndian.size());
  const size_t width = littleEndian.size() * 8;
  const bool negative = width > 0 && ((bits >> (width - 1)) & 1u) != 0;
  if (negative && width < 64) bits |= ~uint64_t{0} << width;
  Value* out = make(Kind::Int);
  out->integer = static_cast<int64_t>(bits);
  push(out);
}

bool Machine::text(uint8_t op) {
  switch (op) {
    case 'X':
      pushText(take(takeUnsigned(4)));
      return true;
    case 0x8c:
      pushText(take(takeUnsigned(1)));
      return true;
    case 0x8d:
      pushText(take(takeUnsigned(8)));
      return true;
    case 'T':
      pushLatin1(take(takeUnsigned(4)));
      return true;
    case 'U':
      pushLatin1(take(takeUnsigned(1)));
      return true;
    case 'B':
      pushBytes(take(takeUnsigned(4)));
      return true;
    case 'C':
      pushBytes(take(takeUnsigned(1)));
      return true;
    case 0x8e:
    case 0x96:  // a bytearray
      pushBytes(take(takeUnsigned(8)));
      return true;
    default:
      return false;
  }
}

void Machine::pushText(std::string_view utf8) {
  if (!isUtf8(utf8)) refuse("UTF-8 text", "other bytes");
  Value* out = make(Kind::Text);
  out->text = utf8;
  push(out);
}

/// Python 2 wrote its text as bytes.
void Machine::pushLatin1(std::string_view bytes) {
  Value* out = make(Kind::Text);
  out->text = utf8FromLatin1(bytes);
  push(out);
}

void Machine::pushBytes(std::string_view bytes) {
  Value* out = make(Kind::Bytes);
  out->text = bytes;
  push(out);
}

}  // namespace marey::pickle
