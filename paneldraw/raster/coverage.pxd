from paneldraw.raster.cone cimport Filter
from paneldraw.raster.surface cimport Surface

cdef class Supersample:
    cdef readonly int n
    cdef readonly object reference
    cdef bint corner

cdef class Coverage:
    cdef Surface surface
    cdef Filter filter
    # The sub-pixels along each side of a pixel; sub-pixel g has its reference point at 512 g - middle on the lattice.
    cdef int n, middle
    # The sub-scanlines that count for a row of pixels, and how many of them lie before the row begins.
    cdef int lines, lead
    # Half of the pixels that a span's end changes; in what coverage is measured.
    cdef int reach, shift, full
    # Whether pixels may be covered in part, and whether some are.
    cdef bint partial, dirty
    # To divide by n and by 2 * full, and for which of these.
    cdef long long n_inverse, full_inverse
    cdef int n_divided, full_divided
    # The sub-scanlines and the sub-pixels that can be seen.
    cdef long long first, end, low, high
    # A row of changes for each row of pixels that is open, from `row` in the place `slot` on, up to sub-scanline
    # `limit`; between which places they may differ from zero.
    cdef object memory, scratch_memory
    cdef int *changes
    cdef int room, columns, rows, row, slot
    cdef long long limit
    cdef int[16] touched_first
    cdef int[16] touched_end

    cdef object begin(self, object antialias)
    cdef object _make_room(self)
    cdef int *row_of_changes(self) except NULL
    cdef char *scratch(self, Py_ssize_t size) except? NULL
    cdef void spans(self, long long h, long long *ends, int count) noexcept nogil
    cdef void row_of_spans(self, long long y, long long *ends, int count) noexcept nogil
    cdef void finish(self) noexcept nogil
    cdef inline void _count(self, long long *ends, int count) noexcept nogil
    cdef void _weigh(self, long long h, long long *ends, int count) noexcept nogil
    cdef void _advance(self, long long h) noexcept nogil
    cdef void _paint_row(self) noexcept nogil
