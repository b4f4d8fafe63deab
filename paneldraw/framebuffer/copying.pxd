from paneldraw.raster.blit cimport Picture
from paneldraw.raster.coverage cimport Coverage
from paneldraw.raster.surface cimport Surface

cdef object write_text(Coverage coverage, object s, object x, object y, object font, object anchor)
cdef object set_text(
    Coverage coverage, object s, object x, object y, object font, object anchor, object line_spacing, object direction,
    object inverse,
)
cdef object write_box(
    Coverage coverage, object s, object x, object y, object w, object h, object font, tuple style, object inverse
)
cdef object _stamp(Coverage coverage, object shares, long long left, long long top, bint inverse)
cdef object paint_picture(Surface surface, object picture, object x, object y, object dither, object op)
cdef object paint_seen(
    Surface surface, object before, object picture, tuple place, object fill, dict options, dict tones
)
cdef int operation(object op) except -1
cdef object copy_levels(
    Surface surface, object source, object cover, object x, object y, object key, object palette, object op
)
cdef Picture _levels_of(Surface surface, object source, object palette)
cdef object move_levels(Surface surface, object dx, object dy, object c)
