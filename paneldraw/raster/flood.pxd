from paneldraw.raster.surface cimport Surface

cdef class Flood:
    cdef Surface surface, marks
    cdef int level
    cdef bint border
    cdef bytearray memory
    cdef long long *places
    cdef Py_ssize_t waiting
    # The rows between which pixels are marked.
    cdef long long top, bottom

    cdef bint takes(self, long long x, long long y) noexcept nogil
    cdef object push(self, long long x, long long y)
    cdef Py_ssize_t run(self) except -1
    cdef object look(self, long long left, long long right, long long y)

cdef Py_ssize_t flood(Surface surface, long long x, long long y, int level, bint border) except -1
