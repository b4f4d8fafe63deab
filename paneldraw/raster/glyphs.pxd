from paneldraw.raster.coverage cimport Coverage
from paneldraw.raster.surface cimport Surface

cdef class Glyphs:
    cdef readonly int left, right, top, bottom, gap
    cdef readonly bint overlapping
    cdef object picture_of
    cdef object kept
    cdef int *firsts
    cdef short *spans
    cdef short *advances
    cdef short *boxes
    cdef int[256] near
    cdef dict far

    cdef object _point(self)
    cdef int find(self, unsigned int code) except? -1
    cdef int add(self, unsigned int code) except? -1
    cdef Py_ssize_t advance(self, str text) except? -1

cdef bint one_line(str text) except? -1
cdef object write(Surface surface, Glyphs glyphs, str text, long long x, long long y, long long factor)
cdef object stamp(
    Coverage coverage, unsigned char *mask, Py_ssize_t width, Py_ssize_t height, long long x, long long y
)
