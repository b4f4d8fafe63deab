from paneldraw.raster.surface cimport Surface

cdef long long WHOLE

cdef void bresenham(Surface surface, long long x1, long long y1, long long x2, long long y2) noexcept nogil
cdef void bresenham_part(
    Surface surface, long long x1, long long y1, long long x2, long long y2, long long start, long long stop
) noexcept nogil
cdef void dda_part(
    Surface surface, long long x1, long long y1, long long x2, long long y2, long long start, long long stop
) noexcept nogil
cdef void dashed(
    Surface surface, long long x1, long long y1, long long x2, long long y2,
    long long *pattern, Py_ssize_t count, long long phase, bint dda,
) noexcept nogil
cdef object far(Surface surface, object x1, object y1, object x2, object y2, object pattern, object phase)
