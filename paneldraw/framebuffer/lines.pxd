from paneldraw.framebuffer.paths cimport Paths

cdef class Lines(Paths):
    cdef object _thin(self, object x1, object y1, object x2, object y2)
    cdef object _thin_far(self, object x1, object y1, object x2, object y2)
    cdef object _thick(
        self, object x1, object y1, object x2, object y2, object width, bint square, object antialias
    )
    cdef object _thick_far(
        self, object x1, object y1, object x2, object y2, object width, bint square, object antialias
    )
    cdef object _thin_lines(self, object numbers, object lengths, bint dda)
    cdef object _thick_lines(self, object numbers, long long width, bint square, object antialias)
    cdef object _rectangle(
        self, long long x1, long long y1, long long x2, long long y2, long long width, bint square, object antialias
    )
