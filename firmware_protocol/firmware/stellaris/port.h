/* A Stellaris evaluation board with a Cortex-M3 and a panel: the LM3S811, or with -DPD_LM3S6965 the LM3S6965. */
#ifndef PANELDRAW_PORT_H
#define PANELDRAW_PORT_H

#include <stdint.h>

#define PD_RING_SIZE 2048
#define PD_TX_SIZE 128
#define PD_MAX_PAYLOAD 250
#define PD_STORE_SIZE 2048
#define PD_RATES {115200UL}
#define PD_RESET_LINE 0

#ifdef PD_LM3S6965 /* a 128 x 64 panel of 16 levels on SPI */
#define PD_BUS PD_BUS_IS_SPI
#define PD_ADDRESS 0
#define PD_CONTROLLER "ssd0323"
#define PD_WIDTH 128
#define PD_HEIGHT 64
#define PD_FIRMWARE "paneldraw-lm3s6965 1.0"
#define PD_CONTROL_EACH 0
#else /* LM3S811: a 96 x 16 panel on I2C */
#define PD_BUS PD_BUS_IS_I2C
#define PD_READS 1
#define PD_ADDRESS 0x3D
#define PD_CONTROLLER "ssd0303"
#define PD_WIDTH 96
#define PD_HEIGHT 16
#define PD_FIRMWARE "paneldraw-lm3s811 1.0"
#define PD_CONTROL_EACH 1
#endif

#define PD_FLASH
#define PD_READ_FLASH(p) (*(p))
#define PD_READ_FLASH_LONG(p) (*(p))
#define PD_GUARDED(statement) \
    do { \
        uint32_t masked; \
        __asm__ volatile("mrs %0, primask\n\tcpsid i" : "=r"(masked)::"memory"); \
        statement; \
        __asm__ volatile("msr primask, %0" ::"r"(masked) : "memory"); \
    } while (0)

static inline uint16_t pd_crc(uint16_t crc, uint8_t byte)
{
    uint16_t mixed = (uint16_t)(crc >> 8 ^ byte);
    mixed ^= mixed >> 4;
    return (uint16_t)(crc << 8 ^ mixed << 12 ^ mixed << 5 ^ mixed);
}

#endif
