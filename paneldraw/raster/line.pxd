from paneldraw.raster.surface cimport Surface

cdef void bresenham(Surface surface, long long x1, long long y1, long long x2, long long y2) noexcept nogil
cdef void dashed(
    Surface surface, long long x1, long long y1, long long x2, long long y2, long long *pattern, Py_ssize_t count,
    long long phase, bint dda,
) noexcept nogil
cdef object polyline(
    Surface surface, long long *points, Py_ssize_t count, bint closed, long long *pattern, Py_ssize_t lengths,
    long long phase, bint dda,
)

# A line as it is walked: along its longer axis, x, from its first pixel to its last. What a step adds to a pixel's index,
# and how many steps and moves to the side it has.
cdef struct Walk:
    long long x
    long long y
    bint steep
    bint back
    bint up
    long long index
    Py_ssize_t along
    Py_ssize_t across
    long long dx
    long long dy
    long long first
    long long last
    long long moved

cdef bint _cut(Walk *walk, Surface surface, long long start, long long stop) noexcept nogil
cdef void _dda(Surface surface, Walk *walk) noexcept nogil
cdef void _walk(Surface surface, Walk *walk, bint dda) noexcept nogil
