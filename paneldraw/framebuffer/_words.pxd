cdef inline bint is_word(object value, str word) noexcept:
    return type(value) is str and value == word
