cimport cython

cdef int HORIZONTAL, VERTICAL, PAGE

cdef struct Registers:
    int mode, row, column, left, right, top, bottom

@cython.final
cdef class Writer:
    cdef object fresh, shadow, plan
    cdef unsigned char *new
    cdef unsigned char *old
    cdef bint known
    cdef int cell_bytes, width, height, left, top, ram_width, ram_height, most_pieces
    cdef bint has_pointer, has_window, wraps, turns, _paired
    cdef int pointer_most, _row_command, _row_bytes, _column_command
    cdef tuple _modes
    cdef bytes _write
    cdef int _columns, _rows, _arguments, _longest
    cdef int command_cost, data_cost, chained_cost
    cdef Registers chip, _before
    cdef bint _rehearsing, _filling
    cdef int total, _counted, _kind, _length
    cdef unsigned char *_out
    cdef Py_ssize_t *_starts
    cdef Py_ssize_t *_stops
    cdef Py_ssize_t _end, messages

    cdef void _set_pointer(self, object pointer)
    cdef void _make_room_for(self, int width)
    cdef void sent(self) noexcept
    cdef void forget(self) noexcept
    cdef void restart(self) noexcept
    cdef bint held(self, int row, int column) noexcept
    cdef void begin(self) noexcept
    cdef void rehearse(self) noexcept
    cdef int rehearsed(self) noexcept
    cdef bint windowed(self) noexcept
    cdef void doubt(self) noexcept
    cdef int pointer_bytes(self, int row, int column, int to_row, int to_column) noexcept
    cdef void point(self, int row, int column) noexcept
    cdef void _point_row(self, int row) noexcept
    cdef void _pointer_byte(self, int command) noexcept
    cdef int mode_length(self, int mode) noexcept
    cdef bint columns_hold(self, int left, int right, int rows) noexcept
    cdef bint rows_hold(self, int top, int bottom, int columns) noexcept
    cdef int data_price(self, int bounds) noexcept
    cdef void window(self, int left, int right, int top, int bottom) noexcept
    cdef void set_mode(self, int mode) noexcept
    cdef void _command(self, bytes command) noexcept
    cdef void _bounds(self, int command, int first, int last) noexcept
    cdef void cells(self, int count) noexcept
    cdef void _pass(self, int count) noexcept
    cdef void _put(self, int count) noexcept
    cdef void _step(self) noexcept
    cdef int following(self, int row) noexcept
    cdef void _message(self, int kind) noexcept
    cdef void _make_room(self) noexcept
    cdef void _byte(self, int byte) noexcept
    cdef void finish(self) noexcept
