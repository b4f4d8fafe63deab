from paneldraw.framebuffer.arguments cimport Points
from paneldraw.raster.strokes cimport Contours
from paneldraw.raster.surface cimport Surface

cdef class Paths:
    cdef Surface surface
    cdef object _antialias
    cdef Contours _contours

    cdef object _dip(self, object c, object op)
    cdef int _level(self, object c) except? -1
    cdef object _block(self, object x, object y, object w, object h)
    cdef object _thin_path(self, Points path, bint closed, object dash, bint dda)
    cdef Contours _empty_contours(self, object antialias)
    cdef object _stroke(
        self, Points path, bint closed, object width, int cap, int join, object dash, object antialias
    )
    cdef object _fill_contours(
        self, long long *points, Py_ssize_t *ends, Py_ssize_t contours, bint nonzero, object antialias,
        int unit
    )
    cdef object _add_stroke(
        self,
        Contours contours,
        Points path,
        bint closed,
        double width,
        int cap,
        int join,
        object dash,
        object distance,
    )
