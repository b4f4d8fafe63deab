cdef inline long long floored(double number) noexcept nogil:
    # The processor has an instruction that cuts off; for the floor itself a library would be called.
    cdef long long below = <long long> number
    return below - (number < below)

cdef inline long cut_off(double number) noexcept nogil:
    return <long> number
