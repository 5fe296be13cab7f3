// 16 floats for any processor: plain loops that compilers turn into whatever vectors there are.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace {

constexpr int kTileRows = 2;
constexpr int kTileLanes = 1;
constexpr int kPairRows = 1;  ///< with two panels at once

struct Lanes {
  float v[16];
};

template <typename F>
inline Lanes each(F f) {
  Lanes out;
  for (int i = 0; i < 16; ++i) out.v[i] = f(i);
  return out;
}

inline Lanes load(const float* p) {
  return each([=](int i) { return p[i]; });
}
inline void store(float* p, Lanes a) {
  for (int i = 0; i < 16; ++i) p[i] = a.v[i];
}
inline Lanes all(float x) {
  return each([=](int) { return x; });
}
inline Lanes fma(Lanes a, Lanes b, Lanes c) {
  return each([&](int i) { return a.v[i] * b.v[i] + c.v[i]; });
}
inline Lanes operator+(Lanes a, Lanes b) {
  return each([&](int i) { return a.v[i] + b.v[i]; });
}
inline Lanes operator-(Lanes a, Lanes b) {
  return each([&](int i) { return a.v[i] - b.v[i]; });
}
inline Lanes operator*(Lanes a, Lanes b) {
  return each([&](int i) { return a.v[i] * b.v[i]; });
}
inline Lanes operator/(Lanes a, Lanes b) {
  return each([&](int i) { return a.v[i] / b.v[i]; });
}
inline Lanes squareRoot(Lanes a) {
  return each([&](int i) { return std::sqrt(a.v[i]); });
}
/// NaN in `a` stays NaN.
inline Lanes smaller(Lanes a, Lanes b) {
  return each([&](int i) { return b.v[i] < a.v[i] ? b.v[i] : a.v[i]; });
}
inline Lanes larger(Lanes a, Lanes b) {
  return each([&](int i) { return b.v[i] > a.v[i] ? b.v[i] : a.v[i]; });
}
inline Lanes magnitude(Lanes a) {
  return each([&](int i) { return std::fabs(a.v[i]); });
}
inline Lanes withSignOf(Lanes a, Lanes sign) {
  return each([&](int i) { return std::copysign(a.v[i], sign.v[i]); });
}
/// Where x is negative `a`, else `b`.
inline Lanes ifNegative(Lanes x, Lanes a, Lanes b) {
  return each([&](int i) { return x.v[i] < 0.f ? a.v[i] : b.v[i]; });
}
/// 2 to the power of whole numbers from -126 to 127.
inline Lanes powerOfTwo(Lanes n) {
  return each([&](int i) {
    return std::bit_cast<float>(static_cast<uint32_t>(static_cast<int32_t>(n.v[i]) + 127) << 23);
  });
}
/// Half (0 or 1) of 32 bf16 values: word j holds column j in its low and 16 + j in its high half.
inline Lanes loadBf16(const void* p, int half) {
  uint32_t words[16];
  std::memcpy(words, p, sizeof(words));
  return each([&](int i) {
    return std::bit_cast<float>(half == 0 ? words[i] << 16 : words[i] & 0xFFFF0000u);
  });
}

}  // namespace
