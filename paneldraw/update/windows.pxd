cimport cython

from paneldraw.update.messages cimport Writer

cdef int MOST

cdef struct Piece:
    int row, left, right

cdef struct Box:
    int left, right, top, bottom

@cython.final
cdef class Windows:
    cdef Writer writer
    cdef object _memory
    cdef Piece *pieces
    cdef Box *boxes
    cdef Box _begun
    cdef int *_turns
    cdef int _window_cost

    cdef int stream(self, int count) noexcept
    cdef bint _inside(self, int left, int right, int top, int bottom) noexcept
    cdef int _reach(self, int left, int top, int right, int bottom) noexcept
    cdef int bounding(self, int count) noexcept
    cdef int grown(self, int count) noexcept
    cdef int _partner(self, int new, int count) noexcept
    cdef int _saved(self, Box *one, Box *other) noexcept
    cdef void _join(self, Box *one, Box *other) noexcept
    cdef int tall_first(self, int count) noexcept
    cdef bint cover(self, int count, Piece *piece) noexcept
    cdef int stream_cost(self, int cells) noexcept
    cdef int cost(self, int count) noexcept
    cdef void write(self, int count) noexcept
    cdef void write_plainly(self, int i) noexcept
    cdef int _rehearsed(self, int count, bint turned) noexcept
    cdef void _write(self, int count, bint turned) noexcept
    cdef int _next(self, int done, int count) noexcept
    cdef int _price(self, Box *box) noexcept
    cdef int _begin_early(self, Box *box) noexcept
    cdef int _commands(self, Box *box) noexcept
    cdef void _write_one(self, Box *box, bint last) noexcept
    cdef int _reach_of(self, Box *box, int cells) noexcept
    cdef int _idle_tail(self, Box *box, int mode) noexcept
