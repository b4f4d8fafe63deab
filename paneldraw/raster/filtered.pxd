cimport cython
from paneldraw.raster.cone cimport ConeFilter
from paneldraw.raster.surface cimport Surface

@cython.final
cdef class Volumes:
    cdef object kept, kept_sides
    cdef double radius, scale, sides_scale
    cdef int steps
    cdef double *triangles
    cdef double *sides

    cdef double triangle(self, double d, double t) noexcept nogil
    cdef double side(self, double d) noexcept nogil

cdef object fill(
    Surface surface, ConeFilter cone, long long *points, Py_ssize_t *ends, Py_ssize_t contours, bint nonzero, int unit
)
