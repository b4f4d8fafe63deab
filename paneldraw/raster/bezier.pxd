from paneldraw.raster.surface cimport Surface

cdef class Path:
    # Points x and y in turn.
    cdef double *points
    cdef readonly Py_ssize_t count
    cdef object memory
    cdef Py_ssize_t capacity
    cdef double low, high
    cdef bint whole

    cdef object add(self, double x, double y)
    cdef bint ends_where_it_begins(self) noexcept
    cdef object pieces(self, double *controls, Py_ssize_t count)
    cdef object piece(self, double *controls, Py_ssize_t first)
    cdef bint _is_unseen(self, double *q, int at) noexcept nogil
    cdef object ellipse(self, double x, double y, double a, double b, double angle, double start, double swept)

cdef class Walk:
    cdef Surface surface
    cdef list dash
    cdef long long period, number
    # The last pixel, which is not painted yet, and the one before it; how many of them there are.
    cdef long long x, y, before_x, before_y
    cdef int held
    cdef bint kept

    cdef object along(self, Path path)
    cdef object end(self)
    cdef object step(self, long long x, long long y)
    cdef object _go(self, long long x, long long y)
    cdef object _paint(self, long long x, long long y)
    cdef bint _is_near(self, double x1, double y1, double x2, double y2) noexcept
    cdef object _chord(self, double x1, double y1, double x2, double y2)

cdef object chain(long long *values, Py_ssize_t count)
cdef object through(double *points, Py_ssize_t count, bint closed)
cdef object walk(Surface surface, Path path, object controls, bint closed, list dash)
