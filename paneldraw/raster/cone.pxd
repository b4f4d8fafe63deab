from paneldraw.raster.surface cimport Surface

cdef class ConeFilter:
    cdef readonly double radius
    cdef readonly object filter
    cdef readonly int resolution
    cdef object kept, volumes_of_edges
    cdef double *volumes
    cdef object kept_band
    cdef double fitted, nearest
    cdef int *band
    cdef int farthest

    cdef double volume(self, double u, double v) noexcept nogil
    cdef double profile(self, double v) noexcept nogil
    cdef object fit(self, double width)

cdef void strip(
    Surface surface, ConeFilter cone, double x1, double y1, double x2, double y2, double width, bint square
) noexcept nogil
