from paneldraw.raster.surface cimport Surface

cdef class Supersample:
    cdef readonly int n
    cdef readonly object reference
    cdef bint corner

cdef void paint(Surface surface, Py_ssize_t y, Py_ssize_t *spans, Py_ssize_t count, int n) noexcept nogil
cdef unsigned long long *counts_before(int n) noexcept nogil
