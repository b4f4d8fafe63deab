from paneldraw.raster.coverage cimport Coverage, Edge

cdef object polygon(Coverage coverage, long long *points, Py_ssize_t *ends, Py_ssize_t contours, bint nonzero)
cdef int _collect(
    Coverage coverage, long long *points, Py_ssize_t *ends, Py_ssize_t contours, long long top, long long bottom,
    Edge *edges, int *starting,
) noexcept nogil
cdef void _place(Coverage coverage, Edge *edge, long long x1, long long y1, long long dx, long long dy) noexcept nogil
cdef void _sweep(
    Coverage coverage, long long top, long long bottom, bint nonzero, Edge *edges, int *starting, Edge **active,
    Edge **sides, long long *spans,
) noexcept nogil
cdef void _fill_rows(
    Coverage coverage, long long top, long long bottom, bint nonzero, Edge *edges, int *starting, Edge **active
) noexcept nogil
cdef int _renew(Edge *edges, Edge **active, int crossing, int next, long long h) noexcept nogil
cdef long long _first_end(Edge **active, int crossing, long long end) noexcept nogil
cdef long long _last_start(Edge **active, int crossing, long long start) noexcept nogil
cdef int _rows_in_order(Edge **active, int crossing, int lines, int rows) noexcept nogil
cdef bint _stay_in_order(Edge **active, int crossing, int lines) noexcept nogil
cdef bint _take_block(
    Coverage coverage, Edge **active, int crossing, long long h, int lines, bint nonzero, Edge **sides
) noexcept nogil
cdef void _take_unsteady_block(
    Coverage coverage, Edge **active, int crossing, long long h, int lines, bint nonzero, Edge **before
) noexcept nogil
cdef void _walk(Edge **active, int crossing, long long h, bint nonzero, Coverage coverage, int lines) noexcept nogil
cdef bint _steady(Edge *edge, int lines) noexcept nogil
cdef void _step(Edge *edge, long long lines) noexcept nogil
cdef void _take_row(
    Coverage coverage, Edge **active, int crossing, long long h, bint nonzero, long long *spans
) noexcept nogil
cdef int _spans(
    Edge **active, int crossing, long long h, bint nonzero, long long *spans, int count
) noexcept nogil
cdef void _put_in_order(Edge **active, int crossing) noexcept nogil
cdef void _sort(Edge **active, int crossing) noexcept nogil
cdef bint _is_behind(Edge *a, Edge *b) noexcept nogil
