from paneldraw.framebuffer.painter cimport Painter
from paneldraw.raster.surface cimport Surface

cdef class Framebuffer:
    cdef readonly object pixels
    cdef readonly int depth
    cdef Surface surface
    cdef Painter painter
    cdef tuple _whole
    cdef readonly list _clips
    cdef object __weakref__

    cdef object _draw_on(self, Surface surface, object antialias)

cdef bint _is_of_class_ink(object c) except -1
cdef Framebuffer _unmade()
cdef object _surface_of(object source)
cdef Surface _surface(Framebuffer fb)
