from paneldraw.raster.cone cimport ConeFilter
from paneldraw.raster.supersample cimport Supersample

cdef long long NEAR
cdef long long FAR

cdef long long FIXED_REACH

cdef class Points:
    cdef object kept
    cdef readonly list exact
    cdef long long *values
    cdef Py_ssize_t count

cdef long long quick(object value) noexcept
cdef long long quick_256ths(object value) noexcept
cdef object line_width(object width)
cdef object quick_rows(object source, Py_ssize_t columns, bint flat, long long unit, long long reach)
cdef long long *pointer_to_int64(bytearray numbers) except? NULL
cdef unsigned char *pointer_to_bytes(object array) except? NULL
