from paneldraw.raster.coverage cimport Coverage

# An edge of the sub-scanlines first <= h < end, and where it stands in the present one: `bound` is the first sub-pixel
# at or right of it. From one sub-scanline to the next it moves by a constant, whose whole part is `step`. Fractions come
# in 62 bits. `next` is the number of an edge that starts in the same row of pixels.
cdef struct Edge:
    long long bound
    long long fraction
    long long step
    long long fraction_step
    long long first
    long long end
    int winding
    int next

cdef object polygon(Coverage coverage, long long *points, Py_ssize_t *ends, Py_ssize_t contours, bint nonzero)
cdef int _collect(
    Coverage coverage, long long *points, Py_ssize_t *ends, Py_ssize_t contours, long long top, long long bottom,
    Edge *edges, int *starting,
) noexcept nogil
cdef void _place(Coverage coverage, Edge *edge, long long x1, long long y1, long long dx, long long dy) noexcept nogil
cdef void _sweep(
    Coverage coverage, long long top, long long bottom, bint nonzero, Edge *edges, int *starting, Edge **active,
    long long *spans,
) noexcept nogil
cdef int _spans(Edge **active, int crossing, long long h, bint nonzero, long long *spans) noexcept nogil
cdef void _sort(Edge **active, int crossing) noexcept nogil
