from paneldraw.framebuffer.polygons cimport Polygons

cdef class Shapes(Polygons):
    pass
