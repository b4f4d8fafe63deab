cdef class Cut:
    cdef long long cx, cy
    cdef long long low, high
    cdef bint reflex

    cdef void place(self, long long x, long long y, long long width, int n) noexcept nogil
    cdef void row(self, long long y) noexcept nogil
    cdef Py_ssize_t apply(
        self, Py_ssize_t *spans, Py_ssize_t start, Py_ssize_t count, long long y, long long middle
    ) noexcept nogil
    cdef void widen(self) noexcept nogil
    cdef void confine(self, long long vx, long long vy, long long margin, long long y) noexcept nogil

cdef class Quadrants(Cut):
    cdef int quadrants
    cdef long long half

cdef class Wedge(Cut):
    cdef long long start_x, start_y, end_x, end_y

cdef class SectorOutline(Wedge):
    cdef long long half

    cdef void side(
        self, Py_ssize_t *spans, Py_ssize_t at, long long vx, long long vy, long long y, long long middle,
        Py_ssize_t first, Py_ssize_t last,
    ) noexcept nogil
