cdef class Writer:
    cdef unsigned char[:, ::1] new, old
    cdef bint known
    cdef int width, left, top, ram_width
    cdef bint wraps
    cdef int command_cost, data_cost, chained_cost
    cdef int mode, page, column, window_left, window_right, window_top, window_bottom
    cdef int[::1] _noted
    cdef bint _dry
    cdef int total
    cdef int _kind
    cdef unsigned char[::1] _out
    cdef Py_ssize_t[::1] _starts, _stops
    cdef Py_ssize_t _end, messages

    cdef void forget(self)
    cdef void begin(self)
    cdef void rehearse(self)
    cdef int rehearsed(self)
    cdef bint windowed(self) noexcept
    cdef int pointer_commands(self, int page, int column, int to_page, int to_column) noexcept
    cdef void point(self, int page, int column)
    cdef bint _pointer_byte(self, int command, bint started)
    cdef int window_commands(self, int left, int right, int top, int bottom)
    cdef void window(self, int left, int right, int top, int bottom)
    cdef void set_mode(self, int mode)
    cdef void _command(self, int command, int first, int last)
    cdef void cells(self, int count)
    cdef void _step(self) noexcept
    cdef void _message(self, int kind)
    cdef void _byte(self, int byte) noexcept
    cdef void finish(self)
