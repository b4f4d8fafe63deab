cdef int shortest_path(int[:, ::1] lengths, int[::1] regions, int[:, ::1] table, int[::1] order, int count) except? -1
