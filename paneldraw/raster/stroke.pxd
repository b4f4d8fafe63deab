from paneldraw.raster.coverage cimport Coverage

cdef class Way

cdef class Contours:
    # Contour k has the points from number ends[k - 1] up to ends[k]: x and y in 256ths of a pixel.
    cdef long long *points
    cdef Py_ssize_t *ends
    cdef Py_ssize_t count, contours
    cdef object memory, ends_memory
    cdef Py_ssize_t capacity, ends_capacity
    cdef bint far

    cdef void begin(self)
    cdef object add(self, double x, double y, double dx, double dy)
    cdef object close(self)

cdef class Stroke:
    cdef Contours contours
    cdef double half
    cdef int join
    # The circle that the path goes around, if it does.
    cdef bint around
    cdef double x, y, radius
    # The square that can be seen.
    cdef double low, high

    cdef object path(self, double *points, Py_ssize_t count, bint closed, int cap, int end_cap)
    cdef bint _is_smooth(self, double *points, Py_ssize_t i, Py_ssize_t j, double dot, double cross) noexcept
    cdef object _outline(self, double *points, Py_ssize_t count, Py_ssize_t first, Py_ssize_t last)
    cdef (double, double) _aside(
        self, double *points, Py_ssize_t count, Py_ssize_t i, Py_ssize_t first, Py_ssize_t last
    ) noexcept
    cdef (double, double) _direction(self, double x, double y, double ux, double uy) noexcept
    cdef object _segment(
        self, double x1, double y1, double x2, double y2, (double, double) start, (double, double) end
    )
    cdef object _cap(self, double x, double y, double ux, double uy, int cap)
    cdef object _corner(self, double x, double y, double vx, double vy, double ux, double uy)
    cdef object _arc(self, double x, double y, double dx, double dy, double ex, double ey, double angle)
    cdef bint _is_seen(self, double left, double right, double top, double bottom, double margin) noexcept
    cdef double _next_seen(self, Way view, double start, int cap) noexcept
    cdef (double, double) _seen(self, double *points, Py_ssize_t count, Py_ssize_t i, int cap) noexcept
    cdef bint _is_corner_seen(self, double *points, Py_ssize_t i, double ux, double uy) noexcept
    cdef bint _covers_all(self, double x, double y) noexcept
    cdef list _without_closed_gaps(self, list dash, int cap, double whole)
    cdef object _first_corner(self, double *points, Py_ssize_t count)
    cdef object dashes(self, double *points, Py_ssize_t count, bint closed, int cap, list dash, double distance)

cdef class Way:
    cdef double *points
    cdef Py_ssize_t count, i
    cdef double passed, ahead
    cdef bint ended
    cdef object memory
    cdef double *cut

    cdef object begin(self, double *points, Py_ssize_t count)
    cdef bint reach(self, double distance) noexcept
    cdef void move(self) noexcept
    cdef Py_ssize_t piece(self, double start, double end) except -1

cdef Py_ssize_t distinct(long long *values, Py_ssize_t count, double *points) noexcept nogil
cdef bint is_endless(double *points, Py_ssize_t count, bint closed, double dash) noexcept
cdef object arc_path(double x, double y, double radius, double start, double swept)
cdef double *doubles(object memory, Py_ssize_t first)
cdef double _length(double *points, Py_ssize_t i, Py_ssize_t j) noexcept
