cdef class Contours:
    cdef object kept, kept_ends
    cdef long long *points
    cdef Py_ssize_t *ends
    cdef Py_ssize_t capacity, room_for_ends, count, contours
    cdef int fineness
    cdef double radius

    cdef object begin(self, int fineness, double radius)
    cdef object add(self, double x, double y)
    cdef object add_whole(self, long long x, long long y)
    cdef object close(self)
    cdef void reverse(self) noexcept nogil
    cdef object cut(self, long long cx, long long cy, double vx, double vy, double margin)
    cdef object end(self)

cdef class Dashes:
    cdef Contours contours
    cdef object pattern, kept
    cdef double left, top, right, bottom, margin, period, rest, width
    cdef int phase, cap, join
    cdef Py_ssize_t count
    cdef double *piece

    cdef object stroke(self, double *path, Py_ssize_t count, double width, int cap, int join)
    cdef object _segment(self, double x, double y, double ux, double uy, double length)
    cdef object _add(self, double x, double y)
    cdef object _finish(self, int end_cap)
    cdef object _next(self)
    cdef object _skip(self, double length)

cdef object stroke(
    Contours contours, double *path, Py_ssize_t count, bint closed, double width, int cap, int end_cap, int join
)
