cdef class Surface:
    cdef unsigned char *pixels
    cdef readonly object memory
    cdef object scratch, kept, boundary
    cdef char *room
    cdef Surface mask
    cdef readonly Py_ssize_t origin, stride, width, height
    cdef readonly Py_ssize_t left, top, right, bottom
    cdef readonly int max_level
    cdef unsigned char[256] ink
    cdef int level, op
    cdef long long *cells
    cdef int n, full
    cdef long long n_inverse, full_inverse

    cdef object reserve(self)
    cdef object make_room(self, Py_ssize_t size)
    cdef Surface single_row(self)
    cdef void dip(self, int level, int op) noexcept nogil
    cdef void point(self, Py_ssize_t x, Py_ssize_t y) noexcept nogil
    cdef void span(self, Py_ssize_t y, Py_ssize_t x1, Py_ssize_t x2) noexcept nogil
    cdef void count_in(self, int n, int full) noexcept nogil
    cdef void spans(self, Py_ssize_t y, Py_ssize_t *bounds, Py_ssize_t count) noexcept nogil
    cdef void _ink(self, Py_ssize_t row, Py_ssize_t x1, Py_ssize_t x2) noexcept nogil
    cdef long long blend(self, Py_ssize_t y, Py_ssize_t x1, Py_ssize_t x2, long long open_spans) noexcept nogil
    cdef void blend_eight(self, Py_ssize_t y, Py_ssize_t x, unsigned long long counts) noexcept nogil
