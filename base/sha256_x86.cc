#include "base/sha256.h"

#if defined(__x86_64__)
#include <cpuid.h>
#include <immintrin.h>
#endif

namespace base {

#if defined(__x86_64__)
namespace {

bool has_instructions() {
  static const bool kHas = [] {
    unsigned a = 0;
    unsigned b = 0;
    unsigned c = 0;
    unsigned d = 0;
    if (__get_cpuid(1, &a, &b, &c, &d) == 0 || (c & bit_SSE4_1) == 0) return false;
    return __get_cpuid_count(7, 0, &a, &b, &c, &d) != 0 && (b & (1u << 29)) != 0;
  }();
  return kHas;
}

// Two rounds per instruction; the four words after are scheduled meanwhile. The instructions
// want the state as ABEF and CDGH.
__attribute__((target("sha,sse4.1"))) void compress(__m128i& abef, __m128i& cdgh,
                                                    const uint8_t* block) {
  const __m128i kSwap = _mm_set_epi64x(0x0c0d0e0f08090a0b, 0x0405060700010203);
  __m128i m[4];
  for (int i = 0; i < 4; ++i) {
    m[i] =
        _mm_shuffle_epi8(_mm_loadu_si128(reinterpret_cast<const __m128i*>(block + i * 16)), kSwap);
  }
  const __m128i saved_abef = abef;
  const __m128i saved_cdgh = cdgh;
#pragma GCC unroll 16
  for (int g = 0; g < 16; ++g) {
    __m128i& now = m[g % 4];
    __m128i& next = m[(g + 1) % 4];
    __m128i& last = m[(g + 3) % 4];
    __m128i sum =
        _mm_add_epi32(now, _mm_load_si128(reinterpret_cast<const __m128i*>(kSha256Round + g * 4)));
    cdgh = _mm_sha256rnds2_epu32(cdgh, abef, sum);
    if (g >= 3 && g < 15) {
      next = _mm_sha256msg2_epu32(_mm_add_epi32(next, _mm_alignr_epi8(now, last, 4)), now);
    }
    abef = _mm_sha256rnds2_epu32(abef, cdgh, _mm_shuffle_epi32(sum, 0x0e));
    if (g >= 1 && g < 13) last = _mm_sha256msg1_epu32(last, now);
  }
  abef = _mm_add_epi32(abef, saved_abef);
  cdgh = _mm_add_epi32(cdgh, saved_cdgh);
}

__attribute__((target("sha,sse4.1"))) void blocks_x86(Sha256State& state, const uint8_t* data,
                                                      size_t blocks) {
  auto* words = reinterpret_cast<__m128i*>(state.data());
  __m128i cdab = _mm_shuffle_epi32(_mm_loadu_si128(words), 0xb1);
  __m128i efgh = _mm_shuffle_epi32(_mm_loadu_si128(words + 1), 0x1b);
  __m128i abef = _mm_alignr_epi8(cdab, efgh, 8);
  __m128i cdgh = _mm_blend_epi16(efgh, cdab, 0xf0);
  for (size_t i = 0; i < blocks; ++i) compress(abef, cdgh, data + i * 64);
  __m128i feba = _mm_shuffle_epi32(abef, 0x1b);
  __m128i dchg = _mm_shuffle_epi32(cdgh, 0xb1);
  _mm_storeu_si128(words, _mm_blend_epi16(feba, dchg, 0xf0));
  _mm_storeu_si128(words + 1, _mm_alignr_epi8(dchg, feba, 8));
}

}  // namespace

bool sha256_blocks_x86(Sha256State& state, const uint8_t* data, size_t blocks) {
  if (!has_instructions()) return false;
  blocks_x86(state, data, blocks);
  return true;
}
#else
bool sha256_blocks_x86(Sha256State&, const uint8_t*, size_t) { return false; }
#endif

}  // namespace base
