from paneldraw.update.messages cimport Writer

cdef class Windows:
    cdef Writer writer
    cdef int[:, ::1] pieces, boxes, _kept
    cdef int _window_cost

    cdef int stream(self, int count)
    cdef bint _inside(self, int left, int right, int top, int bottom) noexcept
    cdef int _reach(self, int left, int top, int right, int bottom) noexcept
    cdef int bounding(self, int count)
    cdef int grown(self, int count)
    cdef int _partner(self, int new, int boxes)
    cdef int _saved(self, int i, int j)
    cdef void _join(self, int one, int other)
    cdef void _swap(self, int one, int other)
    cdef int tall_first(self, int count)
    cdef bint cover(self, int boxes, int piece)
    cdef int stream_cost(self, int stream)
    cdef int cost(self, int count)
    cdef void write(self, int count)
    cdef int _rehearsed(self, int count, bint turned)
    cdef void _copy(self, int[:, ::1] source, int[:, ::1] target, int count)
    cdef void _write(self, int count, bint turned)
    cdef int _reach_of(self, int i, int cells)
    cdef int _begin_early(self, int i)
    cdef int _price(self, int i)
    cdef int _area(self, int i) noexcept
    cdef int _commands(self, int i)
    cdef void _write_one(self, int i, bint last)
    cdef int _idle_tail(self, int i, int mode)
