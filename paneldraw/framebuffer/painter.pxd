from paneldraw.framebuffer.arguments cimport Numbers
from paneldraw.raster.bezier cimport Path
from paneldraw.raster.coverage cimport Coverage
from paneldraw.raster.disc cimport Part
from paneldraw.raster.stroke cimport Contours
from paneldraw.raster.surface cimport Surface

# What a call paints with. Lengths are in 256ths of a pixel.
cdef class Style:
    cdef object antialias
    cdef list dash
    cdef long long width
    cdef int cap, join
    # Whether lines are one pixel wide and aliased.
    cdef bint thin
    # Whether a head is at an end, which then has no cap.
    cdef bint butt_start, butt_end

cdef class Painter:
    cdef Surface surface
    cdef Coverage coverage
    cdef Contours contours
    cdef Style kept_style
    cdef object antialias
    # The round shape that is being drawn: its center and its radii.
    cdef long long x, y, a, b

    cdef object paint_with(self, object c, object op)
    cdef Style style(
        self, object c, object op, object width, object antialias, object cap=*, object join=*, object dash=*
    )
    cdef object points(self, Numbers numbers)
    cdef object fill(self, object c)
    cdef object run(self, object x, object y, object length, bint across, object c, object op)
    cdef object line(self, object x1, object y1, object x2, object y2, Style style, bint dda)
    cdef object segments(self, Numbers numbers, Style style, bint dda)
    cdef object segment(self, long long x1, long long y1, long long x2, long long y2, Style style, bint dda)
    cdef object path(self, str name, object points, bint closed, Style style)
    cdef object arrow(self, int kind, str name, object points, object head, tuple pointed, Style style)
    cdef object _thin_arrow(self, int kind, str name, object points, object shape, Style style)
    cdef list _chords(self, int kind, Numbers numbers, Style style)
    cdef object some_corners(
        self, object x, object y, object w, object h, object r, int corners, bint fill, Style style
    )
    cdef object curve(self, object points, bint closed, bint fill, Style style)
    cdef object smooth(self, object points, bint closed, bint fill, Style style)
    cdef object triangle(
        self, object x1, object y1, object x2, object y2, object x3, object y3, bint fill, bint covered, Style style
    )
    cdef object polygon(self, object coords, bint fill, bint nonzero, bint covered, Style style)
    cdef object box(self, object x, object y, object w, object h, object r, bint fill, Style style)
    cdef object turned_box(
        self, object x, object y, object w, object h, object angle, bint fill, Style style
    )
    cdef object turned_ellipse(
        self, object x, object y, object xr, object yr, object angle, bint fill, Style style
    )
    cdef object elliptical_turn(
        self, object x, object y, object r, object yr, object start, object swept, Style style
    )
    cdef object flood(self, object x, object y, object c, object border, object op)
    cdef object circle(self, object x, object y, object r, bint fill, Style style)
    cdef object ellipse(self, object x, object y, object xr, object yr, bint fill, int quadrants, Style style)
    cdef object slice(
        self, object x, object y, object r, object start, object end, object swept, bint fill, Style style
    )
    cdef object turn(self, object x, object y, object r, object start, object end, object swept, Style style)

    cdef object _rectangle(self, long long x1, long long y1, long long x2, long long y2, Style style)
    cdef object _thin_path(self, Surface surface, Numbers numbers, bint closed, Style style)
    cdef object _wide_path(self, long long *values, Py_ssize_t count, bint closed, Style style)
    cdef bint _add_piece(
        self, long long *values, Py_ssize_t count, bint closed, Style style, double distance, bint alone
    ) except -1
    cdef object _add_stroke(
        self, double *points, Py_ssize_t count, bint closed, Style style, double distance, tuple circle
    )
    cdef object _chain(self, object controls, bint closed, bint fill, Style style)
    cdef object _fill_chain(self, object controls, Path path, Style style)
    cdef Path _ellipse(self, double x, double y, double a, double b, double angle, Style style)
    cdef object _add_ellipse(
        self, double x, double y, double a, double b, double angle, double beyond, Style style
    )
    cdef object _far_ellipse(self, object x, object y, object a, object b, object angle, bint fill, Style style)
    cdef Path _new_path(self, Style style)
    cdef object _smooth_path(self, Path path, bint closed, Style style)
    cdef object _fill_contours(self, Style style, bint nonzero)
    cdef object _fill(
        self, Surface surface, long long *points, Py_ssize_t count, bint nonzero, object antialias
    )
    cdef object _fill_polygon(self, Numbers corners, object coords, bint nonzero, bint covered, Style style)
    cdef object _thin_rect(self, long long left, long long top, long long right, long long bottom, bint fill)
    cdef list _read_round(self, object x, object y, object a, object b, str name_a, str name_b, Style style)
    cdef object _round_shape(
        self, long long left, long long top, long long right, long long bottom, long long a, long long b, bint sharp,
        bint fill, Part part, Style style,
    )
    cdef object _thin_arc(self, long long cx, long long cy, long long radius, object start, object swept, Style style)
    cdef object _dashed_arc(self, object memory, tuple circle, bint closed, Style style)

    cdef object _far_line(self, object ends, Style style, bint dda)
    cdef object _far_thin_path(self, Surface surface, object points, bint closed, object dash, bint dda)
    cdef object _far_path(self, object points, bint closed, Style style)
    cdef object _far_curve(self, object controls, bint closed, bint fill, Style style)
    cdef object _add_far_path(self, object points, bint closed, Style style)
    cdef object _add_polygons(self, object shape)
    cdef object _far_fill(self, object shape, bint nonzero, Style style)
    cdef object _far_outlines(self, object paths, bint closed, bint fill, bint nonzero, Style style)
    cdef object _far_box(self, object box, object a, object b, bint sharp, bint fill, Style style)
    cdef object _far_quarters(self, object x, object y, object a, object b, int quadrants, bint fill, Style style)
    cdef object _far_turn(
        self, object x, object y, object r, object start, object swept, bint is_sector, bint fill, Style style
    )

cdef object _as_area(Style style)
