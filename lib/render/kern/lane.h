/* lane - LANES floats, integers or truths side by side: what the kernels compute with, in C and in OpenCL C 1.2, from one source.
 *
 * fv, iv, uv are floats, signed and unsigned integers of 32 bits, one a lane; + - * / & | ^ << >> work on them as on scalars, and
 * scalars spread over all lanes. mv is a truth a lane, made by lt, le, ilt, ieq; &, | and NOT work on it. Its value differs from one
 * build to the next and is never used: SEL(m, a, b), any, count and bits_of read it.
 *
 * Only + - * / and sqrt of floats, integer operations and in-range conversions are used: each is exact or correctly rounded,
 * nothing is contracted, no lane looks at another one, and so every build gives the same bits at every width. */
#ifndef KERN_LANE_H
#define KERN_LANE_H

#include "render/kern/chunk.h"

#ifndef LANES
#define LANES 1
#endif
#define PASTE_(a, b) a##b
#define PASTE(a, b) PASTE_(a, b)
#define EACH_LANE(i) for (int i = 0; i < LANES; i++)

#ifdef __OPENCL_VERSION__
/* ------------------------------------------------------------------ OpenCL */
#if LANES == 1
typedef float fv;
typedef int iv, mv;
typedef uint uv;
#define WIDE
#define LANE(v, i) (v)
#define TRUTH(c) (-(c))    /* a scalar comparison gives 1, one of vectors -1 */
#else
typedef PASTE(float, LANES) fv;
typedef PASTE(int, LANES) iv, mv;
typedef PASTE(uint, LANES) uv;
#define WIDE LANES
#define LANE(v, i) (((__private int *)&(v))[i])
#define TRUTH(c) (c)
#endif
#define LANE_FLOAT(v, i) as_float(LANE(v, i))
#define FV(x) ((fv)(x))
#define IV(x) ((iv)(x))
#define UV(x) ((uv)(x))
#define NO_LANE ((mv)(0))
#define ALL_LANES ((mv)(-1))
#define NOT(m) (~(m))
#define SEL(m, a, b) ((m) ? (a) : (b))
FN fv bits_float(uv x) { return PASTE(as_float, WIDE)(x); }
FN uv float_bits(fv x) { return PASTE(as_uint, WIDE)(x); }
FN iv signed_of(uv x) { return PASTE(as_int, WIDE)(x); }
FN uv unsigned_of(iv x) { return PASTE(as_uint, WIDE)(x); }
FN fv to_float(iv x) { return PASTE(convert_float, WIDE)(x); }
FN iv to_int(fv x) { return PASTE(PASTE(convert_int, WIDE), _rtz)(x); }
FN fv fv_sqrt(fv x) { return sqrt(x); }
FN mv lt(fv a, fv b) { return TRUTH(a < b); }
FN mv le(fv a, fv b) { return TRUTH(a <= b); }
FN mv ilt(iv a, iv b) { return TRUTH(a < b); }
FN mv ieq(iv a, iv b) { return TRUTH(a == b); }
#if LANES == 16
#define EACH_AT(at, p, i) (at(p, i.s0), at(p, i.s1), at(p, i.s2), at(p, i.s3), at(p, i.s4), at(p, i.s5), at(p, i.s6), at(p, i.s7), \
                           at(p, i.s8), at(p, i.s9), at(p, i.sa), at(p, i.sb), at(p, i.sc), at(p, i.sd), at(p, i.se), at(p, i.sf))
#elif LANES == 8
#define EACH_AT(at, p, i) (at(p, i.s0), at(p, i.s1), at(p, i.s2), at(p, i.s3), at(p, i.s4), at(p, i.s5), at(p, i.s6), at(p, i.s7))
#elif LANES == 4
#define EACH_AT(at, p, i) (at(p, i.x), at(p, i.y), at(p, i.z), at(p, i.w))
#else
#define EACH_AT(at, p, i) (at(p, i))
#endif
/* Truths. Drivers of CPUs are made of clang, one of whose built-ins gives a bit a lane at once; others go by a byte a lane, for the
 * built-in any may test lane by lane. */
#define any(m) any_lane(m)
FN uint32 bits_of_bytes(ulong a) { return (uint32)(((a & 0x8040201008040201ul) * 0x0101010101010101ul) >> 56); }
#if LANES == 16 && defined __clang__ && defined __AVX512DQ__
#define BITS_OF(m) (uint32)(ushort)__builtin_ia32_cvtd2mask512(m)
#elif LANES == 8 && defined __clang__ && defined __AVX2__
#define BITS_OF(m) (uint32)__builtin_ia32_movmskps256(as_float8(m))
#endif
#ifdef BITS_OF
FN uint32 bits_of(mv m) { return BITS_OF(m); }
FN int count(mv m) { return (int)popcount(BITS_OF(m)); }
FN int any_lane(mv m) { return BITS_OF(m) != 0; }
#elif LANES == 16
FN ulong2 bytes_of(mv m) { return as_ulong2(convert_char16(m)); }
FN uint32 bits_of(mv m) { ulong2 a = bytes_of(m); return bits_of_bytes(a.x) | bits_of_bytes(a.y) << 8; }
FN int count(mv m) { ulong2 a = bytes_of(m); return (int)((popcount(a.x) + popcount(a.y)) >> 3); }
FN int any_lane(mv m)
{
	return (m.s0 | m.s1 | m.s2 | m.s3 | m.s4 | m.s5 | m.s6 | m.s7 | m.s8 | m.s9 | m.sa | m.sb | m.sc | m.sd | m.se | m.sf) != 0;
}
#elif LANES == 8
FN ulong bytes_of(mv m) { return as_ulong(convert_char8(m)); }
FN uint32 bits_of(mv m) { return bits_of_bytes(bytes_of(m)); }
FN int count(mv m) { return (int)(popcount(bytes_of(m)) >> 3); }
FN int any_lane(mv m) { return (m.s0 | m.s1 | m.s2 | m.s3 | m.s4 | m.s5 | m.s6 | m.s7) != 0; }
#elif LANES == 4
FN uint32 bits_of(mv m) { return (uint32)((m.x & 1) | (m.y & 2) | (m.z & 4) | (m.w & 8)); }
FN int count(mv m) { return (int)popcount(bits_of(m)); }
FN int any_lane(mv m) { return (m.x | m.y | m.z | m.w) != 0; }
#else
FN uint32 bits_of(mv m) { return (uint32)(m & 1); }
FN int count(mv m) { return m & 1; }
FN int any_lane(mv m) { return m; }
#endif
FN uint32 lowest(uint32 bits) { return 31 - clz(bits & -bits); }
typedef float8 f8;
typedef long8 l8;
FN l8 l8_of(f8 x) { return convert_long8_rtz(x); }
FN f8 f8_of(l8 x) { return convert_float8(x); }
FN l8 l8_sum(l8 a, l8 b) { return as_long8(as_ulong8(a) + as_ulong8(b)); }    /* may wrap */
#if LANES > 1
/* Loaded and stored whole: vstore8 may be two halves, for which a load that soon follows waits. */
typedef long8 __attribute__((aligned(8))) l8_anywhere;
FN l8 l8_load(GLOBAL const int64 *p) { return *(GLOBAL const l8_anywhere *)p; }
FN void l8_store(GLOBAL int64 *p, l8 x) { *(GLOBAL l8_anywhere *)p = x; }
#else
FN l8 l8_load(GLOBAL const int64 *p) { return vload8(0, p); }
FN void l8_store(GLOBAL int64 *p, l8 x) { vstore8(x, 0, p); }
#endif
#define PART(v, i) (((__private int64 *)&(v))[i])
#define F8(...) ((f8)(__VA_ARGS__))
#define L8(...) ((l8)(__VA_ARGS__))
FN uint64 high_product(uint64 a, uint64 b) { return (a | b) >> 32 ? mul_hi(a, b) : 0; }    /* as a rule it is 0 */
FN fv gather(mv m, FLOATS p, iv i) { i &= m; return (fv)EACH_AT(float_at, p, i); }
FN iv igather(mv m, INTS p, iv i) { i &= m; return (iv)EACH_AT(int_at, p, i); }
#if CHUNKS > 1 || LANES == 1
FN void gather4(mv m, FLOATS p, iv i, int offset, fv *out)
{
	for (int k = 0; k < 4; k++)
		out[k] = gather(m, p, i + (offset + k));
}
FN void igather2(mv m, INTS p, iv i, iv *out)
{
	out[0] = igather(m, p, i);
	out[1] = igather(m, p, i + 1);
}
#else
#define PAIR(k) vload2(0, p + i.k)
#define ROW(k) vload4(0, p + i.k)
/* A row is one load; the rest is the transposition of rows of 128 bits, four lanes apart in a vector. By clang's own shuffle, since
 * vectors written element by element may be made element by element; drivers of CPUs are made of clang. */
#define MIX(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#if LANES == 16
#define TWO(a, b) MIX(ROW(a), ROW(b), 0, 1, 2, 3, 4, 5, 6, 7)
#define ROWS(a, b, c, d) MIX(TWO(a, b), TWO(c, d), 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
#define EACH_ROW fv r0 = ROWS(s0, s4, s8, sc), r1 = ROWS(s1, s5, s9, sd), r2 = ROWS(s2, s6, sa, se), r3 = ROWS(s3, s7, sb, sf)
#define LOW(a, b) MIX(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29)
#define HIGH(a, b) MIX(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31)
#define LOW2(a, b) MIX(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29)
#define HIGH2(a, b) MIX(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31)
#elif LANES == 8
#define EACH_ROW fv r0 = (fv)(ROW(s0), ROW(s4)), r1 = (fv)(ROW(s1), ROW(s5)), r2 = (fv)(ROW(s2), ROW(s6)), r3 = (fv)(ROW(s3), ROW(s7))
#define LOW(a, b) MIX(a, b, 0, 8, 1, 9, 4, 12, 5, 13)
#define HIGH(a, b) MIX(a, b, 2, 10, 3, 11, 6, 14, 7, 15)
#define LOW2(a, b) MIX(a, b, 0, 1, 8, 9, 4, 5, 12, 13)
#define HIGH2(a, b) MIX(a, b, 2, 3, 10, 11, 6, 7, 14, 15)
#else
#define EACH_ROW fv r0 = ROW(s0), r1 = ROW(s1), r2 = ROW(s2), r3 = ROW(s3)
#define LOW(a, b) MIX(a, b, 0, 4, 1, 5)
#define HIGH(a, b) MIX(a, b, 2, 6, 3, 7)
#define LOW2(a, b) MIX(a, b, 0, 1, 4, 5)
#define HIGH2(a, b) MIX(a, b, 2, 3, 6, 7)
#endif
FN void gather4(mv m, FLOATS p, iv i, int offset, fv *out)
{
	i &= m;
	p += offset;
	EACH_ROW;
	fv a = LOW(r0, r1), b = HIGH(r0, r1), c = LOW(r2, r3), d = HIGH(r2, r3);
	out[0] = LOW2(a, c);
	out[1] = HIGH2(a, c);
	out[2] = LOW2(b, d);
	out[3] = HIGH2(b, d);
}
FN void igather2(mv m, INTS p, iv i, iv *out)
{
	i &= m;
#if LANES == 16
	iv a = (iv)(PAIR(s0), PAIR(s1), PAIR(s2), PAIR(s3), PAIR(s4), PAIR(s5), PAIR(s6), PAIR(s7));
	iv b = (iv)(PAIR(s8), PAIR(s9), PAIR(sa), PAIR(sb), PAIR(sc), PAIR(sd), PAIR(se), PAIR(sf));
#elif LANES == 8
	int8 a = (int8)(PAIR(s0), PAIR(s1), PAIR(s2), PAIR(s3)), b = (int8)(PAIR(s4), PAIR(s5), PAIR(s6), PAIR(s7));
#else
	int4 a = (int4)(PAIR(s0), PAIR(s1)), b = (int4)(PAIR(s2), PAIR(s3));
#endif
	out[0] = (iv)(a.even, b.even);
	out[1] = (iv)(a.odd, b.odd);
}
#undef PAIR
#endif

#else
/* ------------------------------------------------------------------ C */
typedef float f8 __attribute__((vector_size(32)));
typedef int64 l8 __attribute__((vector_size(64)));
FN l8 l8_of(f8 x) { return __builtin_convertvector(x, l8); }
FN f8 f8_of(l8 x) { return __builtin_convertvector(x, f8); }
typedef uint64 ul8 __attribute__((vector_size(64)));
FN l8 l8_sum(l8 a, l8 b) { return (l8)((ul8)a + (ul8)b); }    /* may wrap */
FN l8 l8_load(const int64 *p) { l8 x; memcpy(&x, p, sizeof x); return x; }
FN void l8_store(int64 *p, l8 x) { memcpy(p, &x, sizeof x); }
#define PART(v, i) (v)[i]
#define F8(...) ((f8){ __VA_ARGS__ })
#define L8(...) ((l8){ __VA_ARGS__ })
FN uint64 high_product(uint64 a, uint64 b) { return (uint64)((unsigned __int128)a * b >> 64); }
#if LANES == 1
typedef float fv;
typedef int32_t iv, mv;
typedef uint32_t uv;
#define LANE(v, i) (*((void)(i), &(v)))
#define FV(x) ((float)(x))
#define IV(x) ((int32_t)(x))
#define UV(x) ((uint32_t)(x))
#define NO_LANE 0
#define ALL_LANES (-1)
#define NOT(m) (~(m))
#define SEL(m, a, b) ((m) ? (a) : (b))
FN fv bits_float(uv x) { float f; memcpy(&f, &x, 4); return f; }
FN uv float_bits(fv x) { uint32_t u; memcpy(&u, &x, 4); return u; }
FN fv to_float(iv x) { return (float)x; }
FN iv to_int(fv x) { return (int32_t)x; }
FN mv lt(fv a, fv b) { return -(a < b); }
FN mv le(fv a, fv b) { return -(a <= b); }
FN mv ilt(iv a, iv b) { return -(a < b); }
FN mv ieq(iv a, iv b) { return -(a == b); }
FN fv fv_sqrt(fv x) { return __builtin_sqrtf(x); }
FN uint32 bits_of(mv m) { return m & 1; }
FN fv gather(mv m, const float *p, iv i) { return m ? p[i] : 0.f; }
FN iv igather(mv m, const int *p, iv i) { return m ? p[i] : 0; }
#else
#include <immintrin.h>
typedef float fv __attribute__((vector_size(4 * LANES)));
typedef int32_t iv __attribute__((vector_size(4 * LANES)));
typedef uint32_t uv __attribute__((vector_size(4 * LANES)));
#define LANE(v, i) ((v)[i])
FN fv FV(float x) { return x - (fv){ 0 }; }
FN iv IV(int32_t x) { return x - (iv){ 0 }; }
FN uv UV(uint32_t x) { return x - (uv){ 0 }; }
FN fv bits_float(uv x) { return (fv)x; }
FN uv float_bits(fv x) { return (uv)x; }
FN fv to_float(iv x) { return __builtin_convertvector(x, fv); }
FN iv to_int(fv x) { return __builtin_convertvector(x, iv); }
#if LANES == 16            /* AVX-512: truths are bits */
typedef __mmask16 mv;
#define NO_LANE ((mv)0)
#define ALL_LANES ((mv)0xffff)
#define NOT(m) ((mv)~(m))
#define SEL(m, a, b) ((__typeof__(a))_mm512_mask_blend_epi32(m, (__m512i)(b), (__m512i)(a)))
FN mv lt(fv a, fv b) { return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ); }
FN mv le(fv a, fv b) { return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LE_OQ); }
FN mv ilt(iv a, iv b) { return _mm512_cmplt_epi32_mask((__m512i)a, (__m512i)b); }
FN mv ieq(iv a, iv b) { return _mm512_cmpeq_epi32_mask((__m512i)a, (__m512i)b); }
FN fv fv_sqrt(fv x) { return (fv)_mm512_sqrt_ps((__m512)x); }
FN uint32 bits_of(mv m) { return m; }
FN fv gather(mv m, const float *p, iv i) { return (fv)_mm512_mask_i32gather_ps(_mm512_setzero_ps(), m, (__m512i)i, p, 4); }
FN iv igather(mv m, const int *p, iv i) { return (iv)_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), m, (__m512i)i, p, 4); }
#else                      /* truths are lanes of 0 or -1 */
typedef iv mv;
#define NO_LANE ((mv){ 0 })
#define ALL_LANES (NO_LANE - 1)
#define NOT(m) (~(m))
FN mv lt(fv a, fv b) { return a < b; }
FN mv le(fv a, fv b) { return a <= b; }
FN mv ilt(iv a, iv b) { return a < b; }
FN mv ieq(iv a, iv b) { return a == b; }
#if LANES == 8             /* AVX2 */
#define SEL(m, a, b) ((__typeof__(a))_mm256_blendv_epi8((__m256i)(b), (__m256i)(a), (__m256i)(m)))
FN fv fv_sqrt(fv x) { return (fv)_mm256_sqrt_ps((__m256)x); }
FN uint32 bits_of(mv m) { return (uint32)_mm256_movemask_ps((__m256)m); }
FN fv gather(mv m, const float *p, iv i) { return (fv)_mm256_mask_i32gather_ps(_mm256_setzero_ps(), p, (__m256i)i, (__m256)m, 4); }
FN iv igather(mv m, const int *p, iv i) { return (iv)_mm256_mask_i32gather_epi32(_mm256_setzero_si256(), p, (__m256i)i, (__m256i)m, 4); }
#else                      /* SSE4.1, 4 lanes */
#define SEL(m, a, b) ((__typeof__(a))_mm_blendv_epi8((__m128i)(b), (__m128i)(a), (__m128i)(m)))
FN fv fv_sqrt(fv x) { return (fv)_mm_sqrt_ps((__m128)x); }
FN uint32 bits_of(mv m) { return (uint32)_mm_movemask_ps((__m128)m); }
FN fv gather(mv m, const float *p, iv i)
{
	fv r = { 0 };
	EACH_LANE(k) r[k] = m[k] ? p[i[k]] : 0.f;
	return r;
}
FN iv igather(mv m, const int *p, iv i)
{
	iv r = { 0 };
	EACH_LANE(k) r[k] = m[k] ? p[i[k]] : 0;
	return r;
}
#endif
#endif
#endif
FN int any(mv m) { return bits_of(m) != 0; }
FN int count(mv m) { return __builtin_popcount(bits_of(m)); }
FN uint32 lowest(uint32 bits) { return (uint32)__builtin_ctz(bits | 0x80000000u); }
FN iv signed_of(uv x) { return (iv)x; }
FN uv unsigned_of(iv x) { return (uv)x; }
#define LANE_FLOAT(v, i) LANE(v, i)

/* Four floats in a row, from p[i + offset] on, or two integers; what comes to lanes outside m has no meaning. */
#if LANES == 1
FN void igather2(mv m, const int *p, iv i, iv *out)
{
	p += m ? i : 0;
	out[0] = p[0];
	out[1] = p[1];
}
FN void gather4(mv m, const float *p, iv i, int offset, fv *out)
{
	p += offset + (m ? i : 0);
	for (int k = 0; k < 4; k++)
		out[k] = p[k];
}
#else
/* A row is one load; the rest is the transposition of rows of 128 bits, four lanes apart in a vector. */
FN void gather4(mv m, const float *p, iv i, int offset, fv *out)
{
	union { iv v; int32_t i[LANES]; } at = { SEL(m, i, IV(0)) };
#define ROW(k) _mm_loadu_ps(p + at.i[k] + offset)
#if LANES == 16
	__m512 r[4];
	for (int k = 0; k < 4; k++) {
		__m256 low = _mm256_insertf128_ps(_mm256_castps128_ps256(ROW(k)), ROW(k + 4), 1);
		__m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(ROW(k + 8)), ROW(k + 12), 1);
		r[k] = _mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
	}
#define T(op, a, b) _mm512_castpd_ps(_mm512_##op##_pd(_mm512_castps_pd(a), _mm512_castps_pd(b)))
	__m512 a = _mm512_unpacklo_ps(r[0], r[1]), b = _mm512_unpackhi_ps(r[0], r[1]);
	__m512 c = _mm512_unpacklo_ps(r[2], r[3]), d = _mm512_unpackhi_ps(r[2], r[3]);
#elif LANES == 8
	__m256 r[4];
	for (int k = 0; k < 4; k++)
		r[k] = _mm256_insertf128_ps(_mm256_castps128_ps256(ROW(k)), ROW(k + 4), 1);
#define T(op, a, b) _mm256_castpd_ps(_mm256_##op##_pd(_mm256_castps_pd(a), _mm256_castps_pd(b)))
	__m256 a = _mm256_unpacklo_ps(r[0], r[1]), b = _mm256_unpackhi_ps(r[0], r[1]);
	__m256 c = _mm256_unpacklo_ps(r[2], r[3]), d = _mm256_unpackhi_ps(r[2], r[3]);
#else
#define T(op, a, b) _mm_castpd_ps(_mm_##op##_pd(_mm_castps_pd(a), _mm_castps_pd(b)))
	__m128 a = _mm_unpacklo_ps(ROW(0), ROW(1)), b = _mm_unpackhi_ps(ROW(0), ROW(1));
	__m128 c = _mm_unpacklo_ps(ROW(2), ROW(3)), d = _mm_unpackhi_ps(ROW(2), ROW(3));
#endif
	out[0] = (fv)T(unpacklo, a, c);
	out[1] = (fv)T(unpackhi, a, c);
	out[2] = (fv)T(unpacklo, b, d);
	out[3] = (fv)T(unpackhi, b, d);
#undef T
#undef ROW
}
FN void igather2(mv m, const int *p, iv i, iv *out)
{
	union { iv v; int32_t i[LANES]; } at = { SEL(m, i, IV(0)) };
#define ROWS(k) _mm_loadh_pi(_mm_castsi128_ps(_mm_loadl_epi64((const __m128i *)(p + at.i[k]))), (const __m64 *)(p + at.i[(k) + 1]))
#if LANES == 16
	__m512 r[2];
	for (int k = 0; k < 2; k++) {
		__m256 low = _mm256_insertf128_ps(_mm256_castps128_ps256(ROWS(2 * k)), ROWS(2 * k + 4), 1);
		__m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(ROWS(2 * k + 8)), ROWS(2 * k + 12), 1);
		r[k] = _mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
	}
	out[0] = (iv)_mm512_shuffle_ps(r[0], r[1], 0x88);
	out[1] = (iv)_mm512_shuffle_ps(r[0], r[1], 0xdd);
#elif LANES == 8
	__m256 r[2];
	for (int k = 0; k < 2; k++)
		r[k] = _mm256_insertf128_ps(_mm256_castps128_ps256(ROWS(2 * k)), ROWS(2 * k + 4), 1);
	out[0] = (iv)_mm256_shuffle_ps(r[0], r[1], 0x88);
	out[1] = (iv)_mm256_shuffle_ps(r[0], r[1], 0xdd);
#else
	out[0] = (iv)_mm_shuffle_ps(ROWS(0), ROWS(2), 0x88);
	out[1] = (iv)_mm_shuffle_ps(ROWS(0), ROWS(2), 0xdd);
#endif
#undef ROWS
}
#endif
#endif

/* ------------------------------------------------------------------ for both */
/* The lanes of m one by one; bits_of has a bit for each. */
#define EACH_LANE_OF(m, i) for (uint32 bits = bits_of(m), i = lowest(bits); bits; bits &= bits - 1, i = lowest(bits))
FN fv fv_min(fv a, fv b) { return SEL(lt(a, b), a, b); }
FN fv fv_max(fv a, fv b) { return SEL(lt(b, a), a, b); }
FN iv iv_min(iv a, iv b) { return SEL(ilt(a, b), a, b); }

/* Change the lanes m of a variable. */
#define SET(m, place, value) ((place) = SEL(m, value, place))
#define SET_TRUTH(m, place, value) ((place) = ((value) & (m)) | ((place) & NOT(m)))

#endif
