/* A program that uses /dev/i2c-1, /dev/spidev0.0 and /dev/gpiochip0 as C programs do: `bus_user WAY [DESCRIPTOR]`. */
#define _DEFAULT_SOURCE
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <glob.h>
#include <linux/gpio.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <linux/spi/spidev.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static int bus;

static void check(int result, const char *what)
{
    if (result < 0) {
        perror(what);
        exit(1);
    }
}

static int opened(const char *path)
{
    int fd = open(path, O_RDWR);
    check(fd, path);
    return fd;
}

/* Writes who it is and a number, 100 times, and reads two bytes back with each. */
static void *write_hundred(void *name)
{
    for (uint8_t i = 0; i < 100; i++) {
        uint8_t out[2] = {(uint8_t)(uintptr_t)name, i}, in[2] = {0};
        struct i2c_msg messages[2] = {{0x3C, 0, 2, out}, {0x3C, I2C_M_RD, 2, in}};
        struct i2c_rdwr_ioctl_data call = {messages, 2};
        check(ioctl(bus, I2C_RDWR, &call), "I2C_RDWR");
        if (in[0] != out[0] || in[1] != i) {
            fprintf(stderr, "%d %d read %d %d\n", out[0], i, in[0], in[1]);
            exit(1);
        }
    }
    return NULL;
}

static void threads(void)
{
    pthread_t all[8];
    for (uintptr_t i = 0; i < 8; i++)
        pthread_create(&all[i], NULL, write_hundred, (void *)i);
    for (int i = 0; i < 8; i++)
        pthread_join(all[i], NULL);
}

static void forks(void)
{
    int status, bad = 0;
    for (uintptr_t i = 1; i < 8; i++)
        if (!fork()) {
            write_hundred((void *)i);
            _exit(0);
        }
    write_hundred((void *)0);
    while (wait(&status) > 0)
        bad |= status;
    exit(bad != 0);
}

static void duplicates(const char *self)
{
    char number[8];
    int copy = dup2(bus, 37);
    close(bus);
    bus = fcntl(copy, F_DUPFD, 50);
    close(37);
    if (open("/dev/null", O_RDWR) < 0 || write(37, "nobody", 6) >= 0 || errno != EBADF)
        exit(2);
    check(ioctl(bus, I2C_SLAVE, 0x3C), "I2C_SLAVE");
    check((int)write(bus, "\x11\x22", 2), "write");
    snprintf(number, sizeof number, "%d", bus);
    execl(self, self, "inherited", number, (char *)NULL);
    exit(3);
}

static void inherited(const char *number)
{
    uint8_t in[2];
    struct stat about;
    bus = atoi(number);
    check((int)read(bus, in, 2), "read");
    check(fstat(bus, &about), "fstat");
    printf("%02x %02x %d\n", in[0], in[1], S_ISCHR(about.st_mode));
}

static int is_bus(const struct dirent *entry)
{
    return !strncmp(entry->d_name, "i2c-", 4) || !strncmp(entry->d_name, "gpiochip", 8);
}

static void looks(void)
{
    struct dirent **names;
    glob_t found;
    int count = scandir("/dev", &names, is_bus, alphasort);
    check(count, "scandir");
    for (int i = 0; i < count; i++)
        puts(names[i]->d_name);
    check(-glob("/dev/i2c*", 0, NULL, &found), "glob");
    for (size_t i = 0; i < found.gl_pathc; i++)
        puts(found.gl_pathv[i]);
    globfree(&found);
}

static void lines(void)
{
    int chip = opened("/dev/gpiochip0"), spi = opened("/dev/spidev0.0");
    struct gpiohandle_request request = {.lineoffsets = {24}, .flags = GPIOHANDLE_REQUEST_OUTPUT, .lines = 1};
    struct gpiohandle_data low = {{0}}, high = {{1}};
    uint8_t commands[2] = {0xA5, 0xAF}, data[4] = {1, 2, 3, 4};
    uint32_t speed = 1000000, answer = 0;
    struct spi_ioc_transfer transfers[2] = {{.tx_buf = (uintptr_t)data, .len = 2},
                                            {.tx_buf = (uintptr_t)(data + 2), .rx_buf = (uintptr_t)data, .len = 2}};
    strcpy(request.consumer_label, "bus_user");
    check(ioctl(chip, GPIO_GET_LINEHANDLE_IOCTL, &request), "LINEHANDLE");
    if (ioctl(chip, GPIO_GET_LINEHANDLE_IOCTL, &request) >= 0 || errno != EBUSY)
        exit(4);
    check(ioctl(spi, SPI_IOC_WR_MAX_SPEED_HZ, &speed), "speed");
    check(ioctl(spi, SPI_IOC_RD_MAX_SPEED_HZ, &answer), "speed");
    check(ioctl(request.fd, GPIOHANDLE_SET_LINE_VALUES_IOCTL, &low), "low");
    check((int)write(spi, commands, 2), "write");
    check(ioctl(request.fd, GPIOHANDLE_SET_LINE_VALUES_IOCTL, &high), "high");
    printf("%u %d\n", answer, ioctl(spi, SPI_IOC_MESSAGE(2), transfers));
}

int main(int count, char **words)
{
    const char *way = count > 1 ? words[1] : "";
    if (!strcmp(way, "inherited"))
        inherited(words[2]);
    else if (!strcmp(way, "lines"))
        lines();
    else if (!strcmp(way, "looks"))
        looks();
    else {
        bus = opened("/dev/i2c-1");
        if (!strcmp(way, "threads"))
            threads();
        else if (!strcmp(way, "forks"))
            forks();
        else if (!strcmp(way, "duplicates"))
            duplicates(words[0]);
        else if (!strcmp(way, "sleeps"))
            for (puts("open"), fflush(stdout);;)
                write_hundred(NULL);
    }
    return 0;
}
