cimport cython

@cython.final
cdef class Boundary:
    cdef object kept_segments, kept_edges
    cdef char *room
    cdef int *order
    cdef int *active
    cdef int *crossing
    cdef double *segments
    cdef Py_ssize_t count, edges, capacity, waiting
    cdef bint nonzero
    cdef double left, top, right, bottom

    cdef object find(
        self, long long *points, Py_ssize_t *ends, Py_ssize_t contours, bint nonzero, double unit
    )
    cdef object _make_room(self, Py_ssize_t edges)
    cdef void _cut_edge(self, double x1, double y1, double x2, double y2, int winding) noexcept nogil
    cdef void _add_edge(
        self, double x, double top, double slope, double x_end, double bottom, int winding
    ) noexcept nogil
    cdef void _sort(self) noexcept nogil
    cdef object _sweep(self)
    cdef void _insert(self, Py_ssize_t count, int edge) noexcept nogil
    cdef object _cross(self, Py_ssize_t count, double y, double end)
    cdef void _look(self, Py_ssize_t i, Py_ssize_t count, double y, double end) noexcept nogil
    cdef object _wind(self, Py_ssize_t count, double y)
    cdef object _turn(self, int edge, double y)
    cdef object _add_segment(self, int edge, double end)
