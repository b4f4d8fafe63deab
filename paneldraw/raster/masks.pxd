from paneldraw.raster.surface cimport Surface

cdef void stamp(
    Surface surface, unsigned char *mask, Py_ssize_t width, Py_ssize_t height, long long x, long long y
) noexcept nogil
