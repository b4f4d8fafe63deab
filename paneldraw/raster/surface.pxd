cdef class Surface:
    cdef unsigned char *pixels
    cdef readonly object memory
    cdef object scratch, kept
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
    cdef bint weighing
    cdef int *kernel
    cdef int *sums
    cdef object sums_kept
    cdef int reach
    cdef Py_ssize_t sums_stride, weighed

    cdef object reserve(self)
    cdef object make_room(self, Py_ssize_t size)
    cdef Surface single_row(self)
    cdef object begin_weighing(self, int *kernel, int reach)
    cdef object finish_weighing(self)
    cdef void weigh(self, Py_ssize_t y, int line, Py_ssize_t a, Py_ssize_t b) noexcept nogil
    cdef void paint_weighed(self, Py_ssize_t y) noexcept nogil
    cdef void dip(self, int level, int op) noexcept nogil
    cdef void point(self, Py_ssize_t x, Py_ssize_t y) noexcept nogil
    cdef void span(self, Py_ssize_t y, Py_ssize_t x1, Py_ssize_t x2) noexcept nogil
    cdef void count_in(self, int n, int full) noexcept nogil
    cdef long long blend(self, Py_ssize_t y, Py_ssize_t x1, Py_ssize_t x2, long long open_spans) noexcept nogil
    cdef void blend_eight(self, Py_ssize_t y, Py_ssize_t x, unsigned long long counts) noexcept nogil
