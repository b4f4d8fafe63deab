cdef enum:
    OVER
    XOR
    ADD
    MAX
    CLEAR

cdef class Surface:
    cdef readonly object memory
    cdef unsigned char *pixels
    cdef readonly Py_ssize_t origin, stride, width, height
    cdef readonly Py_ssize_t left, top, right, bottom
    cdef readonly int max_level
    cdef int level, op
    cdef unsigned char[256] becomes
    cdef Surface marks

    cdef void paint_with(self, int level, int op) noexcept nogil
    cdef void point(self, Py_ssize_t x, Py_ssize_t y) noexcept nogil
    cdef void span(self, Py_ssize_t y, Py_ssize_t x1, Py_ssize_t x2) noexcept nogil
