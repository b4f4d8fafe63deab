from paneldraw.raster.surface cimport ADD, CLEAR, OVER, XOR, Surface

# What paint.py tells of these two, inlined into the loops over pixels of all modules.
cdef inline long long inverse_of(long long full) noexcept nogil:
    return (1LL << 32) // (2 * full) + 1

cdef inline long long meet(
    long long old, long long level, long long covered, long long full, long long inverse, int op, int top
) noexcept nogil:
    cdef long long share
    if op == OVER or op == CLEAR:
        return ((2 * (level - old) * covered + (2 * old + 1) * full) * inverse) >> 32
    share = ((2 * level * covered + full) * inverse) >> 32
    if op == XOR:
        return old ^ share
    if op == ADD:
        return min(old + share, top)
    return max(old, share)

cdef Surface once(Surface surface)
cdef Surface scratch(Surface surface)
cdef void painted(Surface surface, Surface marks, long long top, long long bottom)
cdef void paint_coverage(
    Surface surface, Py_ssize_t y, Py_ssize_t x, int *changes, Py_ssize_t first, Py_ssize_t count, int shift, int full,
    long long inverse,
) noexcept nogil
cdef void paint_eight(
    Surface surface, Py_ssize_t y, Py_ssize_t x, unsigned long long counts, int full, long long inverse
) noexcept nogil
