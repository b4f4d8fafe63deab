/* The SSD1306 that simavr has as a part (GPL, as this program is then), without a microcontroller in front of it. */

#include <string.h>

#include <simavr/avr_twi.h>
#include <simavr/parts/ssd1306_virt.h>
#include <simavr/sim_avr.h>

static avr_t *avr;
static ssd1306_t part;

static void raise(int line, uint32_t value) { avr_raise_irq(part.irq + line, value); }

void part_start(void)
{
    if (!avr) {
        avr = avr_make_mcu_by_name("atmega328p");
        avr_init(avr);
        avr->log = LOG_NONE;
    }
    memset(&part, 0, sizeof part);
    ssd1306_init(avr, &part, SSD1306_VIRT_COLUMNS, 8 * SSD1306_VIRT_PAGES);
}

void part_spi(int data, const uint8_t *bytes, int count)
{
    raise(IRQ_SSD1306_ENABLE, 0);
    raise(IRQ_SSD1306_DATA_INSTRUCTION, data);
    for (int i = 0; i < count; i++)
        raise(IRQ_SSD1306_SPI_BYTE_IN, bytes[i]);
    raise(IRQ_SSD1306_ENABLE, 1);
}

void part_i2c(int address, const uint8_t *bytes, int count)
{
    raise(IRQ_SSD1306_TWI_OUT, avr_twi_irq_msg(TWI_COND_START, address << 1, 0));
    for (int i = 0; i < count; i++)
        raise(IRQ_SSD1306_TWI_OUT, avr_twi_irq_msg(TWI_COND_WRITE, address << 1, bytes[i]));
    raise(IRQ_SSD1306_TWI_OUT, avr_twi_irq_msg(TWI_COND_STOP, address << 1, 0));
}

const uint8_t *part_ram(void) { return part.vram[0]; }
int part_flag(int flag) { return ssd1306_get_flag(&part, flag); }
int part_contrast(void) { return part.contrast_register; }
