cdef long long chord(long long a, long long b, long long y) noexcept nogil
