cdef enum:
    FILTER_FULL = 1024
    FILTER_SHIFT = 10
    # So many sub-scanlines are weighed as one where edges are steep.
    BLOCK = 5

cdef class Profile
cdef class Filter:
    cdef readonly double radius
    cdef readonly object name
    cdef readonly int resolution
    # C(u, v), and how many entries it has along each side, less one.
    cdef readonly object table
    cdef double *volumes
    cdef int steps
    # The sub-pixels along each side of a pixel, the sub-scanlines that cross the circle, and half of the pixels that a
    # span's end changes.
    cdef readonly int n, lines, reach
    # The weights of a span's end, by sub-scanline and by block: see `_weights`.
    cdef object kept_weights
    cdef int *weights
    # The profile that was asked for last.
    cdef Profile latest

    cdef object prepare(self)
    cdef double strip(self, double u, double low, double high) noexcept nogil
    cdef inline double _entry(self, int row, double v) noexcept nogil

cdef class ConeFilter:
    cdef readonly double radius
    cdef readonly object filter
    cdef readonly int resolution
    cdef Filter kept

cdef class Profile:
    cdef Filter filter
    cdef double width, nearest
    cdef long long nearest_part
    cdef int farthest
    cdef object kept
    cdef int *coverage

cdef Profile profile_of(Filter filter, double width)
cdef Filter _tables_of(ConeFilter cone)
