from paneldraw.raster.surface cimport Surface

cdef bint slab(
    Surface surface, long long x1, long long y1, long long x2, long long y2,
    long long width, bint square, int n, bint corner,
) noexcept nogil
cdef void block(
    Surface surface, long long left, long long top, long long right, long long bottom, int n, bint corner
) noexcept nogil
cdef object slab_far(
    Surface surface, object x1, object y1, object x2, object y2, object width, bint square, int n, bint corner
)
