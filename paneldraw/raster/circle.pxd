from paneldraw.raster.surface cimport Surface

cdef class Wedge:
    cdef long long start_u, start_v, end_u, end_v
    cdef bint reflex
    # Of a row, where the wedge begins and ends.
    cdef long long low, high
    # The nearest pixel that `aim` has found yet.
    cdef long long u, v
    cdef unsigned long long distance

    cdef void aim(self, bint at_end, long long x, long long y, long long r, long long dx, long long dy) noexcept nogil
    cdef void consider(self, long long r, long long dx, long long dy, long long u, long long v) noexcept nogil
    cdef void cut(self, long long v, long long reach) noexcept nogil
    cdef void keep_clockwise(self, long long du, long long dv, long long v) noexcept nogil

cdef void circle(Surface surface, long long x, long long y, long long r) noexcept nogil
cdef void disc(Surface surface, long long x, long long y, long long r) noexcept nogil
cdef void round_rect(
    Surface surface, long long left, long long top, long long right, long long bottom, long long r, bint fill
) noexcept nogil
cdef void ellipse(
    Surface surface, long long x, long long y, long long a, long long b, bint fill, int quadrants
) noexcept nogil
cdef object arc(
    Surface surface, long long x, long long y, long long r,
    long long start_x, long long start_y, long long end_x, long long end_y, bint reflex
)
cdef object sector(
    Surface surface, long long x, long long y, long long r,
    long long start_x, long long start_y, long long end_x, long long end_y, bint reflex, bint fill
)

cdef void _octants(
    Surface surface, long long left, long long top, long long right, long long bottom, long long r, bint fill
) noexcept nogil
cdef void _quadrants(
    Surface surface, long long left, long long top, long long right, long long bottom, long long a, long long b,
    bint fill, int quadrants, Wedge wedge,
) noexcept nogil
cdef long long _half_width(long long a, long long b, long long odd, long long v, bint whole) noexcept nogil
cdef void _part(
    Surface surface, long long y, long long left, long long right, long long v, long long inner, long long outer,
    int quadrants, Wedge wedge,
) noexcept nogil
cdef Wedge _wedge(
    long long x, long long y, long long r, long long start_x, long long start_y, long long end_x, long long end_y,
    bint reflex,
)
cdef void _radius(Surface surface, long long x, long long y, long long u, long long v) noexcept nogil
