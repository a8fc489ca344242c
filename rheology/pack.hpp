// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// A pack of lanes on the compiler's own vector type (g++, clang++): a law runs on it as it does on a double.
#include "real.hpp"
#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace grainlaw {

template <class T>
using signed_like = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;
template <class T>
using unsigned_like = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
template <class T, int N>
struct VectorOf {
  typedef T type __attribute__((vector_size(N * sizeof(T))));
};

template <class T, int N>
struct PackMask {
  typename VectorOf<signed_like<T>, N>::type v;
  friend PackMask operator&&(PackMask a, PackMask b) { return {a.v & b.v}; }
  friend PackMask operator||(PackMask a, PackMask b) { return {a.v | b.v}; }
  friend PackMask operator!(PackMask a) { return {~a.v}; }
};

template <class T, int N>
struct PackBits {
  typename VectorOf<unsigned_like<T>, N>::type v;
  friend PackBits operator+(PackBits a, PackBits b) { return {a.v + b.v}; }
  friend PackBits operator|(PackBits a, PackBits b) { return {a.v | b.v}; }
  friend PackBits operator<<(PackBits a, int n) { return {a.v << n}; }
  unsigned_like<T> operator[](int i) const { return v[i]; }
};

template <class T, int N>
struct Pack {
  using Vector = typename VectorOf<T, N>::type;
  using Mask = PackMask<T, N>;
  Vector v;
  Pack() = default;
  constexpr Pack(T s) : v(s - Vector{}) {}
  constexpr explicit Pack(Vector w) : v(w) {}
  static Pack load(const T* p) {
    Pack r;
    __builtin_memcpy(&r.v, p, sizeof r.v);
    return r;
  }
  void store(T* p) const { __builtin_memcpy(p, &v, sizeof v); }
  T operator[](int i) const { return v[i]; }
  friend Pack operator-(Pack a) { return Pack(-a.v); }
  friend Pack operator+(Pack a, Pack b) { return Pack(a.v + b.v); }
  friend Pack operator-(Pack a, Pack b) { return Pack(a.v - b.v); }
  friend Pack operator*(Pack a, Pack b) { return Pack(a.v * b.v); }
  friend Pack operator/(Pack a, Pack b) { return Pack(a.v / b.v); }
  friend Mask operator<(Pack a, Pack b) { return {a.v < b.v}; }
  friend Mask operator>(Pack a, Pack b) { return {a.v > b.v}; }
  friend Mask operator<=(Pack a, Pack b) { return {a.v <= b.v}; }
  friend Mask operator>=(Pack a, Pack b) { return {a.v >= b.v}; }
  friend Mask operator==(Pack a, Pack b) { return {a.v == b.v}; }
  friend Mask operator!=(Pack a, Pack b) { return {a.v != b.v}; }
};

template <class T, int N>
struct RealTraits<Pack<T, N>> {
  using Scalar = T;
  using R = Pack<T, N>;
  using Bits = PackBits<T, N>;
  using Mask = PackMask<T, N>;
  static constexpr int lanes = N;
  static R sqrt(R x) {
    using V = typename R::Vector;  // g++ 12 does not turn the lane loop into one instruction
#if defined(__AVX512F__)
    if constexpr (std::is_same_v<R, Pack<double, 8>>) return R((V)_mm512_maskz_sqrt_pd(0xff, (__m512d)x.v));
    if constexpr (std::is_same_v<R, Pack<float, 16>>) return R((V)_mm512_maskz_sqrt_ps(0xffff, (__m512)x.v));
#endif
#if defined(__AVX__)
    if constexpr (std::is_same_v<R, Pack<double, 4>>) return R((V)_mm256_sqrt_pd((__m256d)x.v));
    if constexpr (std::is_same_v<R, Pack<float, 8>>) return R((V)_mm256_sqrt_ps((__m256)x.v));
#endif
#if defined(__SSE2__)
    if constexpr (std::is_same_v<R, Pack<double, 2>>) return R((V)_mm_sqrt_pd((__m128d)x.v));
    if constexpr (std::is_same_v<R, Pack<float, 4>>) return R((V)_mm_sqrt_ps((__m128)x.v));
#endif
    R r;
    for (int i = 0; i < N; ++i) r.v[i] = std::sqrt(x.v[i]);
    return r;
  }
  static R log(R x) {
    R r;
    for (int i = 0; i < N; ++i) r.v[i] = std::log(x.v[i]);
    return r;
  }
  static R abs(R x) {
    using B = decltype(Bits::v);
    return R((typename R::Vector)((B)x.v & ((unsigned_like<T>(-1) >> 1) | B{})));
  }
  static R select(Mask m, R a, R b) { return R(m.v ? a.v : b.v); }
  static bool any(Mask m) {
#if defined(__AVX512F__)
    if constexpr (sizeof(R) == 64) return _mm512_test_epi64_mask((__m512i)m.v, (__m512i)m.v) != 0;
#endif
#if defined(__AVX__)
    if constexpr (sizeof(R) == 32) return _mm256_movemask_ps((__m256)m.v) != 0;
#endif
#if defined(__SSE2__)
    if constexpr (sizeof(R) == 16) return _mm_movemask_ps((__m128)m.v) != 0;
#endif
    bool r = false;
    for (int i = 0; i < N; ++i) r |= m.v[i] != 0;
    return r;
  }
  static Bits flag(Mask m, unsigned bit) {
    return {(decltype(Bits::v))m.v & (unsigned_like<T>(bit) | decltype(Bits::v){})};
  }
};

/// Width of the packs of this build: one register of the target. A law is a long chain of dependent operations, and
/// the fewer instructions a point takes, the more points the processor overlaps.
#if defined(__AVX512F__)
inline constexpr int pack_bytes = 64;
#elif defined(__AVX__)
inline constexpr int pack_bytes = 32;
#else
inline constexpr int pack_bytes = 16;
#endif
using PackD = Pack<double, pack_bytes / 8>;
using PackF = Pack<float, pack_bytes / 4>;

}  // namespace grainlaw
