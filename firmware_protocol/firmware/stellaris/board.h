/* What the files of this port share: registers, and the two boards that QEMU has. */
#ifndef PANELDRAW_BOARD_H
#define PANELDRAW_BOARD_H

#include "paneldraw.h"

#ifdef PD_LM3S6965
#define CLOCK 8000000UL
#define CRYSTAL 0xEUL
#else
#define CLOCK 6000000UL
#define CRYSTAL 0xBUL
#endif

#define REG(address) (*(volatile uint32_t *)(address))

#define SYSCTL(offset) REG(0x400FE000 + (offset))
#define RESET_CAUSE 0x05C
#define CLOCK_CONFIG 0x060
#define CLOCKS_0 0x100 /* bit 3 watchdog */
#define CLOCKS_1 0x104 /* bit 0 UART0, bit 4 SSI0, bit 12 I2C0 */
#define CLOCKS_2 0x108 /* ports A, B, C, D */

#define PORT_A(offset) REG(0x40004000 + (offset))
#define PORT_B(offset) REG(0x40005000 + (offset))
#define PORT_C(offset) REG(0x40006000 + (offset))
#define PORT_D(offset) REG(0x40007000 + (offset))
#define PIN(number) (4 << (number))
#define DIRECTION 0x400
#define ALTERNATE 0x420
#define OPEN_DRAIN 0x50C
#define DIGITAL 0x51C

/* Its second time-out without a sign of life is a reset. */
#define WATCHDOG(offset) REG(0x40000000 + (offset))
#define WATCHDOG_LOAD 0x00
#define WATCHDOG_CONTROL 0x08
#define WATCHDOG_CLEAR 0x0C

extern volatile uint16_t pd_milliseconds;
void pd_panel_init(void);

#endif
