from paneldraw.raster.surface cimport Surface

cdef long long FAR, BEYOND

cdef class Numbers:
    cdef object memory
    cdef readonly list exact
    cdef long long *values
    cdef Py_ssize_t count

    cdef object read(self, str name, object source, Py_ssize_t columns, long long unit, bint may_be_flat)

cdef extern from *:
    """
    /* Ints of one digit, which coordinates are, without a call. */
    #if !CYTHON_COMPILING_IN_CPYTHON
    #define paneldraw_has_one_digit(number) 0
    #define paneldraw_digit(number) 0
    #elif PY_VERSION_HEX >= 0x030C0000
    #define paneldraw_has_one_digit(number) PyUnstable_Long_IsCompact((PyLongObject *)(number))
    #define paneldraw_digit(number) PyUnstable_Long_CompactValue((PyLongObject *)(number))
    #else
    #if PY_VERSION_HEX < 0x030B0000
    #include "longintrepr.h"
    #endif
    #define paneldraw_has_one_digit(number) (Py_SIZE(number) >= -1 && Py_SIZE(number) <= 1)
    #define paneldraw_digit(number) (Py_SIZE(number) * (long)((PyLongObject *)(number))->ob_digit[0])
    #endif
    """
    bint has_one_digit "paneldraw_has_one_digit"(object number) noexcept
    long digit "paneldraw_digit"(object number) noexcept

# The number, if it is an int of one digit within +-REACH, else FAR.
cdef inline long long quick(object value) noexcept:
    cdef long long number
    if type(value) is int and has_one_digit(value):
        number = digit(value)
        if -131072 <= number <= 131072:
            return number
    return 1LL << 62

cdef inline bint is_word(object value, str word) noexcept:
    return type(value) is str and value == word

cdef Numbers points_of(str name, object source, long long unit)
cdef Numbers rows_of(str name, object source, Py_ssize_t columns, long long unit)
cdef long long near_pixel(str name, object value) except? -1
cdef long long top_left(str name, object value) except? -1
cdef long long coordinate(str name, object value, long long unit) except? -1
cdef long long extent(str name, object value, long long unit) except? -1
cdef int level(Surface surface, object c) except? -1
cdef int level_named(object name, Surface surface, object value) except? -1
cdef long long *int64s(object memory) except? NULL
cdef unsigned char *uint8s(object memory) except? NULL

cdef long long _quick(object value, long long unit) noexcept
cdef object _quick_rows(object source, Py_ssize_t columns, bint flat, long long unit)
cdef bint _read(
    char *at, Py_ssize_t step, Py_ssize_t count, char kind, long long unit, long long *to
) noexcept
