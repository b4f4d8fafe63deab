from paneldraw.raster.coverage cimport Coverage

cdef class Contours:
    # Contour k has the points from number ends[k - 1] up to ends[k]: x and y in 256ths of a pixel.
    cdef long long *points
    cdef Py_ssize_t *ends
    cdef Py_ssize_t count, contours
    cdef object memory, ends_memory
    cdef Py_ssize_t capacity, ends_capacity
    cdef bint far

    cdef void begin(self)
    cdef object add(self, double x, double y)
    cdef object close(self)

cdef class Stroke:
    cdef Contours contours
    cdef double half
    cdef int join
    # The square that can be seen.
    cdef double low, high

    cdef object path(self, double *points, Py_ssize_t count, bint closed, int cap, int end_cap)
    cdef object _segment(self, double x1, double y1, double x2, double y2, double ux, double uy)
    cdef object _cap(self, double x, double y, double ux, double uy, int cap)
    cdef object _corner(self, double x, double y, double vx, double vy, double ux, double uy)
    cdef object _fan(self, double x, double y, double dx, double dy, double ex, double ey, double angle)
    cdef bint _is_seen(self, double left, double right, double top, double bottom, double margin) noexcept
    cdef (double, double) _seen(self, double *points, Py_ssize_t i, int cap) noexcept
    cdef bint _covers_all(self, double x, double y) noexcept
    cdef object dashes(self, double *points, Py_ssize_t count, int cap, list dash, double distance)

cdef Py_ssize_t distinct(long long *values, Py_ssize_t count, double *points) noexcept nogil
cdef bint is_endless(double *points, Py_ssize_t count, bint closed, double dash) noexcept
cdef object arc_path(double x, double y, double radius, double start, double swept)
cdef double *doubles(object memory, Py_ssize_t first)
cdef double _length(double *points, Py_ssize_t i) noexcept
