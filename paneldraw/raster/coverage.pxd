from paneldraw.raster.cone cimport Filter
from paneldraw.raster.surface cimport Surface

cdef enum:
    # The most sub-scanlines of a block, and the bits of a fraction of a sub-pixel: so many, added up, fit in 64 bits.
    MOST = 128
    FRACTION = 55
    # An edge that moves by no more sub-pixels from one sub-scanline to the next is weighed a block at a time: that is
    # off by at most 0.5 of 255, with a box filter by 1.2.
    STEEP = 8

# An edge of the sub-scanlines first <= h < end, and where it stands in the present one: `bound` is the first sub-pixel
# at or right of it. From one sub-scanline to the next it moves by a constant, whose whole part is `step`. Fractions come
# in FRACTION bits. `next` is the number of an edge that starts in the same block.
cdef struct Edge:
    long long bound
    long long fraction
    long long step
    long long fraction_step
    long long first
    long long end
    int winding
    int next
    # Its place before edges were last sorted.
    int rank
    # In a block that has to be walked: in how many of its sub-scanlines spans begin (or else end) at the edge, and
    # where it was before.
    int turns
    long long kept
    long long kept_fraction
    # Where it stands in rows of pixels that are counted eight at a time, and how far it moves, in sub-pixels with 36
    # bits behind the point; from which pixel to which one it runs there.
    int pixel
    int until
    long long at
    long long pace

# What coverage.py tells of it, inlined into the loops over edges.
cdef inline long long place(Edge *edge, long long lines) noexcept nogil:
    return edge.bound + lines * edge.step + ((edge.fraction + lines * edge.fraction_step) >> FRACTION)

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
    # The sub-scanlines of a block, whose straight edges are taken in one call: a row of pixels or a part of it.
    cdef int block
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
    # The rows of pixels that the present sub-scanline reaches: where their changes and the weights of their ends lie.
    cdef int reached
    cdef Py_ssize_t[16] bases
    cdef Py_ssize_t[16] tables

    cdef object begin(self, object antialias)
    cdef object _open_rows(self)
    cdef object _make_room(self)
    cdef int *row_of_changes(self) except NULL
    cdef char *scratch(self, Py_ssize_t size) except? NULL
    cdef void spans(self, long long h, long long *ends, int count) noexcept nogil
    cdef void row_of_spans(self, long long y, long long *ends, int count) noexcept nogil
    cdef void finish(self) noexcept nogil
    cdef void block_of_spans(self, long long h, long long *ends, int count) noexcept nogil
    cdef bint block_of_edges(self, long long h, int lines, Edge **edges, int count) noexcept nogil
    cdef void _set_out(self, Edge **edges, int count) noexcept nogil
    cdef void paint_between(self, long long y, int rows, Edge **edges) noexcept nogil
    cdef inline void _count(self, long long *ends, int count) noexcept nogil
    cdef bint _are_steep(self, Edge **edges, int count) noexcept nogil
    cdef void _count_row(self, long long y, Edge **edges, int count) noexcept nogil
    cdef inline unsigned long long _count_edge(self, Edge *edge, unsigned long long *before) noexcept nogil
    cdef inline void _paint_counted(self, long long y, int first, int end, unsigned long long counts) noexcept nogil
    cdef void _weigh_edges(self, long long h, Edge **edges, int count) noexcept nogil
    cdef inline void _look_up(self, long long h, int lines) noexcept nogil
    cdef inline void _weigh(self, long long *ends, int count) noexcept nogil
    cdef long long _weigh_end(self, long long x, bint opens) noexcept nogil
    cdef void reach_for(self, long long h, int lines) noexcept nogil
    cdef void end_span(self, long long x, bint opens) noexcept nogil
    cdef inline void _touch(self, long long low, long long high) noexcept nogil
    cdef void _advance(self, long long h) noexcept nogil
    cdef void _paint_row(self) noexcept nogil

cdef unsigned long long *counts_before(int n) noexcept nogil
