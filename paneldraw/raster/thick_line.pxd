from paneldraw.raster.coverage cimport Coverage

# Where the sides and the ends bound a sub-scanline from the left and from the right, and how far these bounds move from
# one sub-scanline to the next: sub-pixels with 40 bits behind the point.
cdef struct Bounds:
    long long left
    long long right
    long long back
    long long front
    long long side_step
    long long end_step

cdef void thick_line(
    Coverage coverage, long long x1, long long y1, long long x2, long long y2, long long width, bint square,
) noexcept nogil
cdef object filtered_line(
    Coverage coverage, long long x1, long long y1, long long x2, long long y2, long long width, bint square,
)
cdef void half_plane(long long vx, long long vy, long long margin, long long y, long long *bounds, int at) noexcept nogil

cdef void _upright(
    Coverage coverage, long long left, long long top, long long right, long long bottom
) noexcept nogil
cdef void _exact(
    Coverage coverage, long long first, long long end, long long x1, long long y1, long long dx, long long dy,
    long long inside, long long outside, bint square,
) noexcept nogil
cdef bint _swept(
    Coverage coverage, long long top, long long bottom, long long x1, long long y1, long long dx, long long dy,
    long long inside, long long outside, bint square,
) noexcept nogil
cdef void _sweep(Coverage coverage, long long top, long long bottom, Bounds *at) noexcept nogil
cdef long long _root_of_product(unsigned long long a, unsigned long long b) noexcept nogil

