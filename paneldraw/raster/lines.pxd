from paneldraw.raster.surface cimport Surface

cdef void bresenham(Surface surface, long long x1, long long y1, long long x2, long long y2) noexcept nogil
cdef object bresenham_far(Surface surface, object x1, object y1, object x2, object y2)
