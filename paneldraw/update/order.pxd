cimport cython

cdef int EXACT, IMPROVED

@cython.final
cdef class Order:
    cdef object _memory
    cdef int *_lengths
    cdef int *_table
    cdef int *regions
    cdef int *_order
    cdef int _count

    cdef void set_step(self, int i, int j, int length) noexcept
    cdef int step(self, int i, int j) noexcept
    cdef int shorten(self, int *order, int count) noexcept
    cdef int _bound(self) noexcept
    cdef int _exact(self) noexcept
    cdef int _walk_back(self) noexcept
    cdef int _turn(self, int turn, int following) noexcept
    cdef int _improved(self, int length, int bound) noexcept
    cdef int _without(self, int first, int last) noexcept
    cdef int _inserted(self, int first, int last, int behind) noexcept
    cdef void _move(self, int first, int last, int behind) noexcept
