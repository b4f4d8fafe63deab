from paneldraw.raster.strokes cimport Contours

cdef object add_band(
    Contours contours, object corners, object radii, object half, bint sharp, bint hollow, object parts, object sides
)
