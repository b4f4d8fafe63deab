cdef class Packed:
    cdef readonly object memory
    cdef object held
    cdef unsigned char *data
    cdef Py_ssize_t size
    cdef long long width, height, stride, bits
    cdef int flip
    cdef unsigned int mask
    cdef bint down

    cdef unsigned int fit(self, unsigned int color) noexcept nogil
    cdef unsigned int get(self, long long x, long long y) noexcept nogil
    cdef void put(self, long long x, long long y, unsigned int level) noexcept nogil
    cdef void block(self, long long x, long long y, long long w, long long h, unsigned int level) noexcept nogil
    cdef void row(self, long long start, long long stop, unsigned int level) noexcept nogil
    cdef int head(self, int bit) noexcept nogil
    cdef int tail(self, int bit) noexcept nogil
    cdef void mix(self, long long at, long long count, int mask, unsigned int value) noexcept nogil

cdef void line(
    Packed packed, long long x1, long long y1, long long x2, long long y2, unsigned int level
) noexcept nogil
cdef void flank(
    Packed packed, long long x, long long y, long long a, long long b, bint swapped, bint fill, int quadrants,
    unsigned int level,
) noexcept nogil
cdef object fill_row(Packed packed, list sides, long long x, long long y, long long row, unsigned int level)
cdef void write(
    Packed packed, unsigned char *text, Py_ssize_t count, unsigned char *letters, long long x, long long y,
    unsigned int level,
) noexcept nogil
cdef void blit(Packed packed, Packed source, long long x, long long y, unsigned int key, Packed palette) noexcept nogil
cdef void scroll(Packed packed, long long dx, long long dy) noexcept nogil

cdef void _four(
    Packed packed, long long x, long long y, long long u, long long v, bint fill, int quadrants, unsigned int level
) noexcept nogil
cdef long long _quotient(long long a, long long b) noexcept nogil
cdef int _rows(long long page, long long top, long long bottom) noexcept nogil
cdef void _move(
    Packed packed, long long to, long long count, long long source, long long other, int shift, int head, int inner,
    int tail, bint backwards,
) noexcept nogil
