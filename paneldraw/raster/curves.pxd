from paneldraw.raster.surface cimport Surface

cdef void circle(Surface surface, long long cx, long long cy, long long r, bint fill) noexcept nogil
cdef object circle_far(Surface surface, object cx, object cy, object r, bint fill)
