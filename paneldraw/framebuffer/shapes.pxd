from paneldraw.framebuffer.rounds cimport Rounds

cdef class Shapes(Rounds):
    cdef object _turn(
        self, object x, object y, object r, object start, object end, object c, bint sector, bint fill,
        object width, object antialias, object op,
    )
