from libc.stdint cimport int64_t

from paneldraw.raster.surface cimport Surface

# https://arrow.apache.org/docs/format/CDataInterface.html, as far as it is read here.
cdef struct ArrowArray:
    int64_t length
    int64_t null_count
    int64_t offset
    int64_t n_buffers
    int64_t n_children
    const void **buffers

cdef class Picture:
    cdef Py_buffer view
    cdef bint held
    cdef object memory
    cdef unsigned char *start
    cdef readonly Py_ssize_t width, height
    cdef Py_ssize_t down, across
    cdef readonly bint truths
    cdef bint mapped, binary
    cdef unsigned char[256] table
    cdef Py_ssize_t first, target, count, rows

    cdef bint read(self, object source) except? -1
    cdef bint _read_copy(self, object source) except? -1
    cdef bint read_arrow(self, tuple lent) except? -1
    cdef object read_surface(self, Surface surface)
    cdef int highest(self) noexcept
    cdef object scale(self, int of, int to)
    cdef object look_up(self, bytes levels)
    cdef bint place(self, Surface surface, long long x, long long y) except? -1
    cdef object _copy(self)

cdef void block(
    Surface surface, long long x1, long long y1, long long x2, long long y2, int level, int op
) noexcept nogil
cdef void scroll(Surface surface, long long dx, long long dy, int level) noexcept nogil
cdef object blit(Surface surface, Picture picture, long long x, long long y, int key, int op)
cdef object paint_grays(Surface surface, Picture picture, long long x, long long y, int op)
cdef object mix(Surface surface, Picture picture, Picture opacity, long long x, long long y, int key, int op)
