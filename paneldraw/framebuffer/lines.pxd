from paneldraw.raster.supersample cimport Supersample
from paneldraw.raster.surface cimport Surface

cdef class Lines:
    cdef Surface surface
    cdef object _antialias

    cdef object _dip(self, object c, object op)
    cdef int _level(self, object c) except? -1
    cdef Supersample _samples(self, object antialias)
    cdef object _block(self, object x, object y, object w, object h)
    cdef object _thin(self, object x1, object y1, object x2, object y2)
    cdef object _thin_far(self, object x1, object y1, object x2, object y2)
    cdef object _thick(
        self, object x1, object y1, object x2, object y2, object width, bint square, Supersample samples
    )
