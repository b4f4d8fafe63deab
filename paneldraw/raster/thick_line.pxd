from paneldraw.raster.cone cimport Filter, Profile
from paneldraw.raster.coverage cimport Coverage
from paneldraw.raster.surface cimport Surface

# Where the sides and the ends bound a sub-scanline from the left and from the right, and how far these bounds move from
# one sub-scanline to the next: sub-pixels with 40 bits behind the point.
cdef struct Bounds:
    long long left
    long long right
    long long back
    long long front
    long long side_step
    long long end_step

# A line's own frame, in pixels: where it starts and in which direction u grows; between which u it reaches, and how far
# across. In parts of a profile's entries, `scale` of which are a pixel: how much u grows, and v shrinks, from pixel to
# pixel; and between which u the filter reaches neither end.
cdef struct Frame:
    double x
    double y
    double ux
    double uy
    double before
    double behind
    double half
    double scale
    long long along
    long long across
    long long past_start
    long long before_end

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
cdef void _row(Coverage coverage, long long y, Bounds *at) noexcept nogil
cdef long long _root_of_product(unsigned long long a, unsigned long long b) noexcept nogil

cdef void _filtered_rows(Surface surface, Profile profile, Frame *frame) noexcept nogil
cdef void _filtered_row(
    Surface surface, Profile profile, Frame *frame, Py_ssize_t at, Py_ssize_t count, long long u, long long v
) noexcept nogil
cdef long long _near_end(Filter filter, Frame *frame, double u, double v, long long away) noexcept nogil
