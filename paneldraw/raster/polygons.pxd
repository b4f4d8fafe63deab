from paneldraw.raster.surface cimport Surface

cdef object polygons(
    Surface surface, long long *points, Py_ssize_t *ends, Py_ssize_t contours, bint nonzero, int n, bint corner
)
