cdef class Writer:
    cdef unsigned char[:, ::1] new, old
    cdef bint known
    cdef int cell_bytes, width, height, left, top, ram_width
    cdef bint has_pointer, has_window, wraps
    cdef unsigned char[:, ::1] _modes, _write
    cdef int _columns, _rows, _arguments, _longest
    cdef int command_cost, data_cost, chained_cost
    cdef int mode, row, column, window_left, window_right, window_top, window_bottom
    cdef int[::1] _noted
    cdef bint _dry, _filling
    cdef int total
    cdef int _kind, _length
    cdef unsigned char[::1] _out
    cdef Py_ssize_t[::1] _starts, _stops
    cdef Py_ssize_t _end, messages

    cdef void forget(self)
    cdef void restart(self)
    cdef bint held(self, int row, int column) noexcept
    cdef void begin(self)
    cdef void rehearse(self)
    cdef int rehearsed(self)
    cdef bint windowed(self) noexcept
    cdef int pointer_commands(self, int page, int column, int to_page, int to_column) noexcept
    cdef void point(self, int page, int column)
    cdef bint _pointer_byte(self, int command, bint started)
    cdef int mode_length(self, int mode) noexcept
    cdef bint columns_hold(self, int left, int right, int rows) noexcept
    cdef bint rows_hold(self, int top, int bottom, int columns) noexcept
    cdef int data_price(self, int bounds) noexcept
    cdef void window(self, int left, int right, int top, int bottom)
    cdef void set_mode(self, int mode)
    cdef void _command(self, unsigned char[::1] command)
    cdef void _bounds(self, int command, int first, int last)
    cdef void cells(self, int count)
    cdef void _pass(self, int count)
    cdef void _copy(self, int count)
    cdef void _step(self) noexcept
    cdef void _message(self, int kind)
    cdef void _make_room(self)
    cdef void _byte(self, int byte)
    cdef void finish(self)
