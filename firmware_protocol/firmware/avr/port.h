/* An ATmega328P (Arduino Uno, Nano) with the panel on its I2C pins, or with -DPD_SPI on its SPI pins. */
#ifndef PANELDRAW_PORT_H
#define PANELDRAW_PORT_H

#include <avr/interrupt.h>
#include <avr/pgmspace.h>
#include <util/atomic.h>
#include <util/crc16.h>

#define PD_RING_SIZE 512
#define PD_TX_SIZE 128
#define PD_MAX_PAYLOAD 250
#define PD_STORE_SIZE 720

#ifdef PD_SPI
#define PD_BUS PD_BUS_IS_SPI
#undef PD_ADDRESS
#define PD_ADDRESS 0
#else
#define PD_BUS PD_BUS_IS_I2C
#ifndef PD_ADDRESS
#define PD_ADDRESS 0x3C
#endif
#define PD_READS 1
#endif
/* PD_CONTROLLER, PD_WIDTH and PD_HEIGHT come from the Makefile. */
#define PD_FIRMWARE "paneldraw-atmega328p 1.0"
/* What 16 MHz divides into exactly comes first; 115200 is 2.1 % fast, which 8N1 bears. */
#define PD_RATES {500000UL, 1000000UL, 250000UL, 115200UL}
#define PD_RESET_LINE 1
#ifndef PD_CONTROL_EACH
#define PD_CONTROL_EACH 0
#endif

#define PD_FLASH PROGMEM
#define PD_READ_FLASH(p) pgm_read_byte(p)
#define PD_READ_FLASH_LONG(p) pgm_read_dword(p)
#define PD_GUARDED(statement) \
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) \
    { \
        statement; \
    }
#define pd_crc(crc, byte) _crc_xmodem_update(crc, byte)

#endif
