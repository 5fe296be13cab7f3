// 16 floats in two AVX2 registers. Included by one source alone, compiled for AVX2 and FMA.
#pragma once

#include <immintrin.h>

namespace {

constexpr int kTileRows = 6;  ///< 12 of 16 registers hold sums
constexpr int kTileLanes = 1;
constexpr int kPairRows = 2;  ///< with two panels at once

struct Lanes {
  __m256 a, b;
};

inline Lanes load(const float* p) {
  return {_mm256_loadu_ps(p), _mm256_loadu_ps(p + 8)};
}
inline void store(float* p, Lanes x) {
  _mm256_storeu_ps(p, x.a);
  _mm256_storeu_ps(p + 8, x.b);
}
inline Lanes all(float x) {
  return {_mm256_set1_ps(x), _mm256_set1_ps(x)};
}
inline Lanes fma(Lanes x, Lanes y, Lanes z) {
  return {_mm256_fmadd_ps(x.a, y.a, z.a), _mm256_fmadd_ps(x.b, y.b, z.b)};
}
inline Lanes operator+(Lanes x, Lanes y) {
  return {_mm256_add_ps(x.a, y.a), _mm256_add_ps(x.b, y.b)};
}
inline Lanes operator-(Lanes x, Lanes y) {
  return {_mm256_sub_ps(x.a, y.a), _mm256_sub_ps(x.b, y.b)};
}
inline Lanes operator*(Lanes x, Lanes y) {
  return {_mm256_mul_ps(x.a, y.a), _mm256_mul_ps(x.b, y.b)};
}
inline Lanes operator/(Lanes x, Lanes y) {
  return {_mm256_div_ps(x.a, y.a), _mm256_div_ps(x.b, y.b)};
}
inline Lanes squareRoot(Lanes x) {
  return {_mm256_sqrt_ps(x.a), _mm256_sqrt_ps(x.b)};
}
/// NaN in `x` stays NaN.
inline Lanes smaller(Lanes x, Lanes y) {
  return {_mm256_min_ps(y.a, x.a), _mm256_min_ps(y.b, x.b)};
}
inline Lanes larger(Lanes x, Lanes y) {
  return {_mm256_max_ps(y.a, x.a), _mm256_max_ps(y.b, x.b)};
}
inline Lanes magnitude(Lanes x) {
  const __m256 sign = _mm256_set1_ps(-0.f);
  return {_mm256_andnot_ps(sign, x.a), _mm256_andnot_ps(sign, x.b)};
}
inline Lanes withSignOf(Lanes x, Lanes s) {
  const __m256 sign = _mm256_set1_ps(-0.f);
  return {_mm256_or_ps(x.a, _mm256_and_ps(sign, s.a)), _mm256_or_ps(x.b, _mm256_and_ps(sign, s.b))};
}
/// Where x is negative `y`, else `z`.
inline Lanes ifNegative(Lanes x, Lanes y, Lanes z) {
  const __m256 zero = _mm256_setzero_ps();
  return {_mm256_blendv_ps(z.a, y.a, _mm256_cmp_ps(x.a, zero, _CMP_LT_OQ)),
          _mm256_blendv_ps(z.b, y.b, _mm256_cmp_ps(x.b, zero, _CMP_LT_OQ))};
}
inline __m256 powerOfTwo(__m256 n) {
  const __m256i biased = _mm256_add_epi32(_mm256_cvtps_epi32(n), _mm256_set1_epi32(127));
  return _mm256_castsi256_ps(_mm256_slli_epi32(biased, 23));
}
/// 2 to the power of whole numbers from -126 to 127.
inline Lanes powerOfTwo(Lanes n) {
  return {powerOfTwo(n.a), powerOfTwo(n.b)};
}
inline __m256 halfOfWords(const __m256i* p, int half) {
  const __m256i words = _mm256_loadu_si256(p);
  return _mm256_castsi256_ps(half == 0 ? _mm256_slli_epi32(words, 16)
                                       : _mm256_and_si256(words, _mm256_set1_epi32(0xFFFF << 16)));
}
/// Half (0 or 1) of 32 bf16 values: word j holds column j in its low and 16 + j in its high half.
inline Lanes loadBf16(const void* p, int half) {
  const auto* words = static_cast<const __m256i*>(p);
  return {halfOfWords(words, half), halfOfWords(words + 1, half)};
}

}  // namespace
