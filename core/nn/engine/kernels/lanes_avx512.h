// 16 floats in one AVX-512 register. Included by one source alone, compiled for AVX-512.
#pragma once

#include <immintrin.h>

namespace {

constexpr int kTileRows = 12;  ///< 24 of 32 registers hold sums
constexpr int kTileLanes = 2;
constexpr int kPairRows = 4;  ///< with two panels at once

struct Lanes {
  __m512 v;
};

inline Lanes load(const float* p) {
  return {_mm512_loadu_ps(p)};
}
inline void store(float* p, Lanes a) {
  _mm512_storeu_ps(p, a.v);
}
inline Lanes all(float x) {
  return {_mm512_set1_ps(x)};
}
inline Lanes fma(Lanes a, Lanes b, Lanes c) {
  return {_mm512_fmadd_ps(a.v, b.v, c.v)};
}
inline Lanes operator+(Lanes a, Lanes b) {
  return {_mm512_add_ps(a.v, b.v)};
}
inline Lanes operator-(Lanes a, Lanes b) {
  return {_mm512_sub_ps(a.v, b.v)};
}
inline Lanes operator*(Lanes a, Lanes b) {
  return {_mm512_mul_ps(a.v, b.v)};
}
inline Lanes operator/(Lanes a, Lanes b) {
  return {_mm512_div_ps(a.v, b.v)};
}
inline Lanes squareRoot(Lanes a) {
  return {_mm512_sqrt_ps(a.v)};
}
/// NaN in `a` stays NaN.
inline Lanes smaller(Lanes a, Lanes b) {
  return {_mm512_min_ps(b.v, a.v)};
}
inline Lanes larger(Lanes a, Lanes b) {
  return {_mm512_max_ps(b.v, a.v)};
}
inline Lanes magnitude(Lanes a) {
  return {_mm512_abs_ps(a.v)};
}
inline Lanes withSignOf(Lanes a, Lanes sign) {
  const __m512i bit = _mm512_and_epi32(_mm512_castps_si512(sign.v), _mm512_set1_epi32(1 << 31));
  return {_mm512_castsi512_ps(_mm512_or_epi32(_mm512_castps_si512(a.v), bit))};
}
/// Where x is negative `a`, else `b`.
inline Lanes ifNegative(Lanes x, Lanes a, Lanes b) {
  return {_mm512_mask_blend_ps(_mm512_cmp_ps_mask(x.v, _mm512_setzero_ps(), _CMP_LT_OQ), b.v, a.v)};
}
/// 2 to the power of whole numbers from -126 to 127.
inline Lanes powerOfTwo(Lanes n) {
  const __m512i biased = _mm512_add_epi32(_mm512_cvtps_epi32(n.v), _mm512_set1_epi32(127));
  return {_mm512_castsi512_ps(_mm512_slli_epi32(biased, 23))};
}
/// Half (0 or 1) of 32 bf16 values: word j holds column j in its low and 16 + j in its high half.
inline Lanes loadBf16(const void* p, int half) {
  const __m512i words = _mm512_loadu_si512(p);
  return {_mm512_castsi512_ps(half == 0
                                  ? _mm512_slli_epi32(words, 16)
                                  : _mm512_and_epi32(words, _mm512_set1_epi32(0xFFFF << 16)))};
}

}  // namespace
