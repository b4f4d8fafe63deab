from paneldraw.framebuffer.polygons cimport Polygons
from paneldraw.raster.cone cimport ConeFilter

cdef long long LARGE
cdef long long LARGE_256THS

cdef class Rounds(Polygons):
    cdef object _thin_rect(self, object x, object y, object w, object h, object r, bint fill)
    cdef object _thin_ellipse(self, object x, object y, object xr, object yr, bint fill, int quadrants)
    cdef object _thin_turn(
        self, object x, object y, object r, object start, object end, object swept, bint sector, bint fill
    )
    cdef object _wide_turn(
        self, object x, object y, object r, object start, object end, object swept, bint sector, bint fill,
        object width, object antialias,
    )
    cdef object _rounded(self, object left, object top, object right, object bottom, object r, bint fill)
    cdef object _around(
        self, object x, object y, object a, object b, object width, bint fill, object cut, object antialias
    )
    cdef object _band(
        self, object centers, object a, object b, object width, bint sharp, bint fill, object cut, object antialias
    )
    cdef object _filtered_band(
        self, object centers, object a, object b, object width, bint sharp, bint fill, object cut, ConeFilter cone
    )
