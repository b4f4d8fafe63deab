from paneldraw.raster.outlines cimport Outline
from paneldraw.raster.surface cimport Surface

cdef class Wedge:
    cdef long long start_x, start_y, end_x, end_y
    cdef bint reflex
    cdef long long low, high

    cdef void row(self, long long y, long long reach) noexcept nogil

cdef class Sector(Outline):
    cdef long long cx, cy, r
    cdef bint fill
    cdef Wedge wedge

cdef void rounded(
    Surface surface, long long left, long long top, long long right, long long bottom, long long r, bint fill
) noexcept nogil
cdef void ellipse(
    Surface surface, long long cx, long long cy, long long a, long long b, bint fill, int quadrants, Wedge wedge
) noexcept nogil
cdef object curve_far(
    Surface surface, object centers, object a, object b, bint fill, int quadrants, object wedge
)
cdef object sector_far(Surface surface, object cx, object cy, object r, bint fill, object wedge)
