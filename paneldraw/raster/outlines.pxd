from paneldraw.raster.surface cimport Surface

cdef class Outline:
    cdef void trace(self, Surface surface) noexcept nogil
    cdef object paint(self, Surface surface, long long top, long long bottom)

cdef class Polyline(Outline):
    cdef long long *points
    cdef Py_ssize_t count
    cdef bint closed, dda
    cdef long long *pattern
    cdef Py_ssize_t lengths
