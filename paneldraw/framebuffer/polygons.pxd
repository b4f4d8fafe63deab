from paneldraw.framebuffer.arguments cimport Points
from paneldraw.framebuffer.lines cimport Lines
from paneldraw.raster.supersample cimport Supersample

cdef class Polygons(Lines):
    cdef object _fill_polygon(self, Points corners, bint nonzero, Supersample samples)
    cdef object _outline(
        self, object name, object coords, bint closed, object width, object cap, object join, object dash,
        object antialias,
    )
