from paneldraw.raster.coverage cimport Coverage

# A box, around whose corners lie the quarters of an ellipse with the radii a and b: those of a disc have one center.
# Sharp corners are the box's own.
cdef struct Round:
    long long left
    long long top
    long long right
    long long bottom
    long long a
    long long b
    bint sharp

# The curve and its parallels, half of a width away; of a disc there is no inner one.
cdef struct Edges:
    Round *outer
    Round *inner
    Round *middle
    bint hollow
    long long half

cdef class Part:
    cdef long long start_x, start_y, end_x, end_y
    cdef bint reflex
    cdef int quadrants
    cdef bint spokes
    cdef int cap

    cdef int cut(self, long long *ends, int count, long long y, Round *middle, long long half, long long n) noexcept nogil
    cdef int _wedge(self, long long *ends, int count, long long y) noexcept nogil
    cdef int _quarters(self, long long *ends, int count, long long y, long long half_pixel) noexcept nogil

cdef void disc(Coverage coverage, Round *shape, long long width, Part part) noexcept nogil
cdef void ring(Coverage coverage, Round *shape, long long width, Part part) noexcept nogil
cdef void _sweep(Coverage coverage, Round *shape, long long width, bint hollow, Part part) noexcept nogil
cdef void _lines(Coverage coverage, Edges *edges, Part part, long long first, long long last) noexcept nogil
cdef void _rows(Coverage coverage, Edges *edges, Part part, long long first, long long last) noexcept nogil
cdef void _blocks(Coverage coverage, Edges *edges, Part part, long long first, long long last) noexcept nogil
cdef bint _are_steep(long long *above, long long *ends, long long *below, int count, int block) noexcept nogil
cdef int _spans(Coverage coverage, Edges *edges, Part part, long long h, long long *ends) noexcept nogil
cdef int _cut(Coverage coverage, Edges *edges, Part part, long long h, long long *ends) noexcept nogil
cdef bint _grow(Round *grown, Round *shape, long long n, long long outward) noexcept nogil
cdef void _add_bar(
    long long *ends, int at, long long x, long long y, long long vx, long long vy, long long length, long long half,
) noexcept nogil
cdef int _add_dot(long long *ends, int count, long long x, long long y, long long half) noexcept nogil
cdef int _unite(long long *ends, int count) noexcept nogil
