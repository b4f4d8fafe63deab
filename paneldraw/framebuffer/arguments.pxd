from paneldraw.raster.supersample cimport Supersample

cdef long long NEAR
cdef long long FAR

cdef long long quick(object value) noexcept
cdef long long *pointer_to_int64(object array) except? NULL
cdef unsigned char *pointer_to_bytes(object array) except? NULL
