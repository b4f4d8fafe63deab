from paneldraw.framebuffer.arguments cimport Points
from paneldraw.framebuffer.lines cimport Lines

cdef class Polygons(Lines):
    cdef object _fill_polygon(self, Points corners, bint nonzero, object antialias)
    cdef object _outline(
        self, object name, object coords, bint closed, object width, object cap, object join, object dash,
        object antialias,
    )
