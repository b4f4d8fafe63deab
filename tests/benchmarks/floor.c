/* The floor under a batch of lines: Bresenham's loop as the textbook prints it, no clipping, nothing checked. */

#include <stdint.h>
#include <stdlib.h>

static void line(uint8_t *pixels, int stride, int x1, int y1, int x2, int y2, uint8_t level)
{
    int dx = abs(x2 - x1), dy = abs(y2 - y1);
    int step_x = x1 < x2 ? 1 : -1, step_y = y1 < y2 ? 1 : -1;
    int x = x1, y = y1, p, k;

    if (dx >= dy) {
        p = 2 * dy - dx;
        for (k = 0; k <= dx; k++) {
            pixels[y * stride + x] = level;
            if (p > 0) {
                y += step_y;
                p -= 2 * dx;
            }
            x += step_x;
            p += 2 * dy;
        }
    } else {
        p = 2 * dx - dy;
        for (k = 0; k <= dy; k++) {
            pixels[y * stride + x] = level;
            if (p > 0) {
                x += step_x;
                p -= 2 * dy;
            }
            y += step_y;
            p += 2 * dx;
        }
    }
}

void lines(uint8_t *pixels, int stride, const int32_t *segments, int count, int level)
{
    int k;

    for (k = 0; k < count; k++, segments += 4)
        line(pixels, stride, segments[0], segments[1], segments[2], segments[3], (uint8_t)level);
}
