/* The core on an ordinary computer, for tests and fuzzing; it says of itself what the Python reference device says. */
#ifndef PANELDRAW_PORT_H
#define PANELDRAW_PORT_H

#include <stdint.h>

#ifndef PD_RING_SIZE
#define PD_RING_SIZE 512
#endif
#define PD_TX_SIZE 128
#ifndef PD_MAX_PAYLOAD
#define PD_MAX_PAYLOAD 250
#endif
#define PD_READS 1
#ifndef PD_STORE_SIZE
#define PD_STORE_SIZE 720
#endif
#define PD_BUS PD_BUS_IS_I2C
#define PD_ADDRESS 0x3C
#define PD_CONTROLLER "ssd1306"
#define PD_WIDTH 128
#define PD_HEIGHT 64
#define PD_FIRMWARE "paneldraw reference 1.0"
#define PD_RATES {500000UL, 1000000UL, 250000UL, 115200UL}
#ifndef PD_RESET_LINE
#define PD_RESET_LINE 0
#endif
#ifndef PD_CONTROL_EACH
#define PD_CONTROL_EACH 0
#endif

#define PD_FLASH
#define PD_READ_FLASH(p) (*(p))
#define PD_READ_FLASH_LONG(p) (*(p))
#define PD_GUARDED(statement) \
    do { \
        statement; \
    } while (0)

static inline uint16_t pd_crc(uint16_t crc, uint8_t byte)
{
    crc ^= (uint16_t)(byte << 8);
    for (int bit = 0; bit < 8; bit++)
        crc = (uint16_t)(crc & 0x8000 ? crc << 1 ^ 0x1021 : crc << 1);
    return crc;
}

#endif
