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
    cdef void point(self, long long x, long long y) noexcept nogil
    cdef void span(self, long long y, long long x1, long long x2) noexcept nogil

# What surface.py tells of these two, inlined into the modules that ask.
cdef inline Py_ssize_t near(long long number) noexcept nogil:
    return <Py_ssize_t> number

cdef inline bint holds(Surface surface, long long x, long long y) noexcept nogil:
    return surface.left <= x < surface.right and surface.top <= y < surface.bottom
