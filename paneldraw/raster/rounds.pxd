from paneldraw.raster.cuts cimport Cut
from paneldraw.raster.surface cimport Surface

cdef void band(
    Surface surface, long long left, long long top, long long right, long long bottom, long long a, long long b,
    long long width, bint sharp, bint fill, Cut cut, int n, bint corner,
) noexcept nogil
cdef object band_far(
    Surface surface, object centers, object a, object b, object width, bint sharp, bint fill, object cut,
    int n, bint corner,
)
