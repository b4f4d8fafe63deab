from paneldraw.framebuffer.lines cimport Lines

cdef class Shapes(Lines):
    pass
