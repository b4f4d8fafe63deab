from paneldraw.framebuffer.shapes cimport Shapes

cdef class Framebuffer(Shapes):
    cdef readonly object pixels
    cdef readonly int depth
