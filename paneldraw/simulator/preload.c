/* Loaded into a program by LD_PRELOAD: what it opens as an I2C bus, an SPI bus, a GPIO line or a serial port is a
 * simulated one.
 *
 * The environment variable PANELDRAW_PRELOAD names a folder with a socket, behind which preload.py plays the kernel,
 * and with the files below /dev and /sys that the program shall see instead of the machine's own.
 *
 * An open device is a socket connected to the server: dup, fork and exec keep it open as they keep any file. The kernel
 * gave its near end a name of its own when it was bound, five hexadecimal digits, by which both sides know the device.
 * Requests go another way, a connection for each thread, so that processes that share a device never mix their answers.
 */
#define _GNU_SOURCE
#undef _FORTIFY_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <glob.h>
#include <limits.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <linux/spi/spidev.h>
#include <pthread.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/sysmacros.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <sys/xattr.h>
#include <unistd.h>

#define PUBLIC __attribute__((visibility("default")))
#define MOST_BYTES (1 << 20)
#define MOST_I2C_BYTES 8192
#define MOST_I2C_MESSAGES 42
#define MOST_SPI_TRANSFERS 512
#define MOST_PIECES (MOST_SPI_TRANSFERS + 4)
#define FIRST_PRIVATE 200 /* our own descriptors are out of the way of programs that count on the next number */
#define GPIO_MAGIC 0xB4

enum operation { OPEN, OPEN_STREAM, READ, WRITE, IOCTL, NAME };

struct request {
    uint32_t length, handle, operation;
};
struct reply {
    uint32_t length;
    int32_t result;
};
struct ioctl_head {
    uint32_t request, reserved;
    uint64_t value;
};

/* The next definition of a function that is defined here too. */
#define NEXT(name) \
    static __typeof__(name) *next_##name; \
    if (!next_##name) \
        next_##name = (__typeof__(name) *)dlsym(RTLD_NEXT, #name)

/* -- The folder, and what leads there */

static char folder[sizeof(((struct sockaddr_un *)0)->sun_path)];
static size_t folder_length;
static unsigned char known[4096]; /* whether a descriptor may be ours: a hint, as nobody tells when one is closed */

static int may_be_ours(int fd)
{
    return fd >= (int)sizeof known || (fd >= 0 && known[fd]);
}

static void note(int fd)
{
    if (fd >= 0 && fd < (int)sizeof known)
        known[fd] = 1;
}

static uint32_t handle_of(int fd);
static int folder_of(int directory, char *answer);
static void settle(void);
static int inside; /* whether the present directory is one of the folder's */

static int begins(const char *text, const char *with)
{
    return !strncmp(text, with, strlen(with));
}

static void look_where_we_are(void)
{
    char here[PATH_MAX];
    inside = folder_length && folder_of(AT_FDCWD, here) && begins(here, folder) && here[folder_length] == '/';
}

__attribute__((constructor)) static void set_up(void)
{
    const char *name = getenv("PANELDRAW_PRELOAD");
    if (folder_length || !name || strlen(name) + sizeof "/socket" > sizeof folder)
        return;
    strcpy(folder, name);
    folder_length = strlen(name);
    for (int fd = 0; fd < 256; fd++) /* handed down by the program that executed this one */
        if (handle_of(fd))
            note(fd);
    look_where_we_are();
}

static int is_device(const char *name)
{
    return begins(name, "i2c-") || begins(name, "spidev") || begins(name, "gpiochip");
}

/* Whether a name of /dev is one that the folder has: serial ports are links there. */
static int is_link(const char *path)
{
    char full[PATH_MAX], target[2];
    return snprintf(full, sizeof full, "%s%s", folder, path) < (int)sizeof full &&
           syscall(SYS_readlinkat, AT_FDCWD, full, target, sizeof target) > 0;
}

static int is_replaced(const char *path)
{
    static const char *const places[] = {
        "/sys/class/i2c-dev", "/sys/class/i2c-adapter", "/sys/bus/i2c", "/sys/class/spidev", "/sys/bus/spi",
        "/sys/class/gpio", "/sys/bus/gpio", "/sys/module/spidev", "/sys/module/i2c_dev",
        "/sys/dev/char/89:", "/sys/dev/char/153:", "/sys/dev/char/254:",
    };
    if (begins(path, "/dev/"))
        return is_device(path + 5) || is_link(path);
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        size_t length = strlen(places[i]);
        char next = begins(path, places[i]) ? path[length] : 'x';
        if (next == '/' || !next || (places[i][length - 1] == ':' && next != 'x'))
            return 1;
    }
    return 0;
}

/* What serves a path of the folder: the server, unless it is a plain file. */
static int is_served(const char *path)
{
    static const char *const lines[] = {"export", "unexport", "value", "direction", "active_low", "edge"};
    const char *name = strrchr(path, '/') + 1;
    if (begins(path, "/dev/"))
        return is_device(path + 5);
    if (begins(path, "/sys/class/gpio/"))
        for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
            if (!strcmp(name, lines[i]))
                return 1;
    return 0;
}

/* The folder of a descriptor, or the present one. */
static int folder_of(int directory, char *answer)
{
    char link[32];
    ssize_t length;
    if (directory == AT_FDCWD)
        strcpy(link, "/proc/self/cwd");
    else
        snprintf(link, sizeof link, "/proc/self/fd/%d", directory);
    length = syscall(SYS_readlinkat, AT_FDCWD, link, answer, PATH_MAX - 1);
    if (length < 0)
        return 0;
    answer[length] = 0;
    return 1;
}

/* Where a path leads: to itself, or into the folder, as is then written into `place`. */
static const char *moved(int directory, const char *path, char *place)
{
    int saved = errno;
    char base[PATH_MAX] = "", *end = place + folder_length;
    const char *from = path;
    set_up();
    if (!folder_length || !path || !*path)
        return path;
    if (*path == '/' ? !begins(path, "/dev/") && !begins(path, "/sys/")
                     : !is_device(path) && !strchr(path, '/') && !inside)
        return path;
    if (*path != '/') {
        if (!folder_of(directory, base))
            goto own;
        if (begins(base, folder) && base[folder_length] == '/')
            memmove(base, base + folder_length, strlen(base) - folder_length + 1);
        if (!begins(base, "/dev") && !begins(base, "/sys"))
            goto own;
    }
    if (folder_length + strlen(base) + 1 + strlen(path) >= PATH_MAX)
        goto own;
    memcpy(place, folder, folder_length);
    end = stpcpy(end, base);
    if (*base)
        *end++ = '/';
    while (*from) { /* without what says nothing, // and /./ */
        if (end > place + folder_length && end[-1] == '/' && (*from == '/' || begins(from, "./")))
            from += *from == '/' ? 1 : 2;
        else
            *end++ = *from++;
    }
    *end = 0;
    if (is_replaced(place + folder_length)) {
        if (begins(place + folder_length, "/sys/class/gpio"))
            settle();
        errno = saved;
        return place;
    }
own:
    errno = saved;
    return path;
}

/* -- The server */

static int connected(uint32_t *handle, int flags)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    int fd = socket(AF_UNIX, SOCK_STREAM | flags, 0);
    if (fd < 0)
        return -1;
    memcpy(address.sun_path, folder, folder_length);
    strcpy(address.sun_path + folder_length, "/socket");
    if (!bind(fd, (struct sockaddr *)&address, sizeof(sa_family_t)) &&
        !connect(fd, (struct sockaddr *)&address, sizeof address) && (*handle = handle_of(fd)))
        return fd;
    syscall(SYS_close, fd);
    errno = ENODEV; /* as if the adapter was unplugged */
    return -1;
}

/* The name of a device that is open under a descriptor; 0 if it is something else. */
static uint32_t handle_of(int fd)
{
    struct sockaddr_un own, peer;
    socklen_t own_length = sizeof own, peer_length = sizeof peer;
    int saved = errno;
    uint32_t handle = 0;
    if (folder_length && !getsockname(fd, (struct sockaddr *)&own, &own_length) && own.sun_family == AF_UNIX &&
        own_length == offsetof(struct sockaddr_un, sun_path) + 6 && !own.sun_path[0] &&
        !getpeername(fd, (struct sockaddr *)&peer, &peer_length) &&
        peer_length > offsetof(struct sockaddr_un, sun_path) + folder_length &&
        !memcmp(peer.sun_path, folder, folder_length) && peer.sun_path[folder_length] == '/') {
        char digits[6] = "";
        memcpy(digits, own.sun_path + 1, 5);
        handle = (uint32_t)strtoul(digits, NULL, 16) + 1;
    }
    errno = saved;
    return handle;
}

/* The connection of this thread. */
static __thread __attribute__((tls_model("initial-exec"))) struct {
    int fd;
    pid_t process;
    uint32_t handle; /* 0 while there is none */
} line;
static pthread_key_t at_exit;
static pthread_once_t key_made = PTHREAD_ONCE_INIT;

/* Closes the connection, if its number still is the connection's: a program may have closed what it did not open. */
static void hang_up(void *unused)
{
    (void)unused;
    if (line.handle && handle_of(line.fd) == line.handle)
        syscall(SYS_close, line.fd);
    line.handle = 0;
}

static void make_key(void)
{
    pthread_key_create(&at_exit, hang_up);
}

static int call_up(void)
{
    int fd, high;
    if (line.handle && line.process == getpid() && handle_of(line.fd) == line.handle)
        return line.fd;
    hang_up(NULL);
    fd = connected(&line.handle, SOCK_CLOEXEC);
    if (fd < 0)
        return -1;
    high = (int)syscall(SYS_fcntl, fd, F_DUPFD_CLOEXEC, FIRST_PRIVATE);
    if (high >= 0) {
        syscall(SYS_close, fd);
        fd = high;
    }
    line.fd = fd;
    line.process = getpid();
    pthread_once(&key_made, make_key);
    pthread_setspecific(at_exit, &line);
    return fd;
}

/* Leaves out of a list of pieces what is done. */
static void advance(struct msghdr *pieces, size_t done)
{
    while (pieces->msg_iovlen && done >= pieces->msg_iov->iov_len) {
        done -= pieces->msg_iov->iov_len;
        pieces->msg_iov++;
        pieces->msg_iovlen--;
    }
    if (pieces->msg_iovlen) {
        pieces->msg_iov->iov_base = (char *)pieces->msg_iov->iov_base + done;
        pieces->msg_iov->iov_len -= done;
    }
}

static int send_all(int fd, struct msghdr pieces)
{
    advance(&pieces, 0);
    while (pieces.msg_iovlen) {
        ssize_t done = sendmsg(fd, &pieces, MSG_NOSIGNAL);
        if (done >= 0)
            advance(&pieces, (size_t)done);
        else if (errno != EINTR)
            return -1;
    }
    return 0;
}

/* Receives a reply, and what comes with it into the pieces behind its head. */
static int receive_all(int fd, struct reply *reply, struct msghdr pieces)
{
    size_t got = 0;
    while (got < sizeof *reply || got < sizeof *reply + reply->length) {
        ssize_t more = recvmsg(fd, &pieces, 0);
        if (more < 0 && errno == EINTR)
            continue;
        if (more <= 0) {
            errno = more ? errno : ENODEV;
            return -1;
        }
        got += (size_t)more;
        advance(&pieces, (size_t)more);
    }
    return 0;
}

/* How an exchange ended, where not with a result. */
enum { REFUSED = -1, BROKEN = -2, NOT_SENT = -3 };

/* Sends a request whose pieces, the first left free for its head, and takes the reply likewise. */
static int exchange(int fd, uint32_t handle, enum operation operation, struct iovec *out, int outs, struct iovec *in,
                    int ins)
{
    struct request request = {0, handle, operation};
    struct reply reply = {0, 0};
    struct msghdr there = {.msg_iov = out, .msg_iovlen = (size_t)outs};
    struct msghdr back = {.msg_iov = in, .msg_iovlen = (size_t)ins};
    int sent;
    for (int i = 1; i < outs; i++)
        request.length += (uint32_t)out[i].iov_len;
    out[0] = (struct iovec){&request, sizeof request};
    in[0] = (struct iovec){&reply, sizeof reply};
    sent = send_all(fd, there);
    if (sent || receive_all(fd, &reply, back)) {
        if (errno == EFAULT)
            return BROKEN;
        errno = ENODEV;
        return sent ? NOT_SENT : BROKEN;
    }
    if (reply.result >= 0)
        return reply.result;
    errno = -reply.result;
    return REFUSED;
}

/* The same by this thread's connection, which is given up if it breaks: half a request may have gone. */
static int ask(uint32_t handle, enum operation operation, struct iovec *out, int outs, struct iovec *in, int ins)
{
    int saved = errno, result;
    for (int again = 0;; again++) {
        struct iovec pieces[MOST_PIECES];
        int fd = call_up();
        memcpy(pieces, out, (size_t)outs * sizeof *out);
        result = fd < 0 ? BROKEN : exchange(fd, handle, operation, pieces, outs, in, ins);
        if (result >= 0) {
            errno = saved;
            return result;
        }
        saved = errno;
        if (result != REFUSED)
            hang_up(NULL);
        errno = saved;
        if (result != NOT_SENT || again) /* but to a server that is there again */
            return -1;
    }
}

/* Has the server take what was written to lines' files by other ways than `write`: they may make or end a directory. */
static void settle(void)
{
    struct iovec out[1], in[1];
    ask(0, NAME, out, 1, in, 1);
}

/* Opens what the server serves. */
static int attach(const char *path, int flags, enum operation operation)
{
    uint32_t handle;
    int fd = connected(&handle, flags & O_CLOEXEC ? SOCK_CLOEXEC : 0);
    struct iovec out[2] = {{0}, {(void *)path, strlen(path)}}, in[1];
    if (fd < 0)
        return -1;
    if (exchange(fd, handle, operation, out, 2, in, 1) < 0) {
        int saved = errno;
        syscall(SYS_close, fd);
        errno = saved;
        return -1;
    }
    note(fd);
    return fd;
}

/* -- Requests of ioctl */

static int refuse(int code)
{
    errno = code;
    return -1;
}

/* Whether no memory can be there; worse addresses are found out by the kernel, in send_all. */
static int is_bad(const void *address)
{
    return (uintptr_t)address < 4096;
}

static int rdwr(uint32_t handle, struct ioctl_head *head, const struct i2c_rdwr_ioctl_data *data)
{
    struct packed {
        uint16_t address, flags, length, given;
    } packed[MOST_I2C_MESSAGES];
    struct iovec out[MOST_I2C_MESSAGES + 4], in[MOST_I2C_MESSAGES + 1];
    int outs = 4, ins = 1;
    uint32_t count;
    if (is_bad(data))
        return refuse(EFAULT);
    count = data->nmsgs;
    if (!data->msgs || !count || count > MOST_I2C_MESSAGES)
        return refuse(EINVAL);
    if (is_bad(data->msgs))
        return refuse(EFAULT);
    for (uint32_t i = 0; i < count; i++) {
        const struct i2c_msg *message = &data->msgs[i];
        uint16_t length = message->len, given = length;
        if (length > MOST_I2C_BYTES)
            return refuse(EINVAL);
        if (length && is_bad(message->buf))
            return refuse(EFAULT);
        if (message->flags & I2C_M_RD) {
            given = message->flags & I2C_M_RECV_LEN && length;
            in[ins++] = (struct iovec){message->buf, length};
        }
        packed[i] = (struct packed){message->addr, message->flags, length, given};
        out[outs++] = (struct iovec){message->buf, given};
    }
    out[1] = (struct iovec){head, sizeof *head};
    out[2] = (struct iovec){&count, sizeof count};
    out[3] = (struct iovec){packed, count * sizeof *packed};
    return ask(handle, IOCTL, out, outs, in, ins);
}

static int smbus(uint32_t handle, struct ioctl_head *head, const struct i2c_smbus_ioctl_data *data)
{
    struct {
        uint8_t direction, command;
        uint16_t reserved;
        uint32_t size;
    } packed;
    size_t length;
    struct iovec out[4], in[2];
    if (is_bad(data))
        return refuse(EFAULT);
    packed.direction = (uint8_t)data->read_write;
    packed.command = data->command;
    packed.size = data->size;
    packed.reserved = 0;
    switch (data->size) {
    case I2C_SMBUS_QUICK:
        length = 0;
        break;
    case I2C_SMBUS_BYTE:
        length = data->read_write == I2C_SMBUS_READ;
        break;
    case I2C_SMBUS_BYTE_DATA:
        length = 1;
        break;
    case I2C_SMBUS_WORD_DATA:
    case I2C_SMBUS_PROC_CALL:
        length = 2;
        break;
    default:
        length = data->size > I2C_SMBUS_I2C_BLOCK_DATA ? 0 : I2C_SMBUS_BLOCK_MAX + 2;
    }
    if (!data->data)
        length = 0;
    if (length && is_bad(data->data))
        return refuse(EFAULT);
    out[1] = (struct iovec){head, sizeof *head};
    out[2] = (struct iovec){&packed, sizeof packed};
    out[3] = (struct iovec){data->data, length};
    in[1] = (struct iovec){data->data, length};
    return ask(handle, IOCTL, out, 4, in, 2);
}

static int spi_message(uint32_t handle, struct ioctl_head *head, const struct spi_ioc_transfer *transfers)
{
    struct __attribute__((packed)) packed {
        uint32_t length, speed;
        uint16_t delay;
        uint8_t bits, cs_change, sends, wants;
    } packed[MOST_SPI_TRANSFERS];
    struct iovec out[MOST_PIECES], in[MOST_SPI_TRANSFERS + 1];
    int outs = 4, ins = 1;
    uint32_t count = _IOC_SIZE(head->request) / sizeof *transfers;
    uint64_t total = 0;
    if (count && is_bad(transfers))
        return refuse(EFAULT);
    for (uint32_t i = 0; i < count; i++) {
        const struct spi_ioc_transfer *each = &transfers[i];
        packed[i] = (struct packed){each->len, each->speed_hz, each->delay_usecs, each->bits_per_word,
                                    each->cs_change, each->tx_buf != 0, each->rx_buf != 0};
        total += each->len;
        if (total > MOST_BYTES)
            return refuse(EMSGSIZE);
        if (each->tx_buf)
            out[outs++] = (struct iovec){(void *)(uintptr_t)each->tx_buf, each->len};
        if (each->rx_buf)
            in[ins++] = (struct iovec){(void *)(uintptr_t)each->rx_buf, each->len};
    }
    out[1] = (struct iovec){head, sizeof *head};
    out[2] = (struct iovec){&count, sizeof count};
    out[3] = (struct iovec){packed, count * sizeof *packed};
    return ask(handle, IOCTL, out, outs, in, ins);
}

/* A request that says itself how many bytes go there and back. */
static int plain(uint32_t handle, struct ioctl_head *head, void *argument)
{
    size_t length = _IOC_SIZE(head->request);
    int writes = _IOC_DIR(head->request) & _IOC_WRITE, reads = _IOC_DIR(head->request) & _IOC_READ;
    struct iovec out[3], in[2] = {{0}, {argument, reads ? length : 0}};
    if (length && is_bad(argument))
        return refuse(EFAULT);
    out[1] = (struct iovec){head, sizeof *head};
    out[2] = (struct iovec){argument, writes ? length : 0};
    return ask(handle, IOCTL, out, 3, in, 2);
}

/* Asks for GPIO lines, which have a descriptor of their own. All three kinds of request end with its number. */
static int claim(uint32_t handle, struct ioctl_head *head, void *argument)
{
    int fd, result, saved;
    size_t length = _IOC_SIZE(head->request);
    struct iovec out[3], in[1];
    if (is_bad(argument))
        return refuse(EFAULT);
    fd = attach("lines", O_CLOEXEC, OPEN);
    if (fd < 0)
        return -1;
    head->value = handle_of(fd);
    out[1] = (struct iovec){head, sizeof *head};
    out[2] = (struct iovec){argument, length};
    result = ask(handle, IOCTL, out, 3, in, 1);
    if (result < 0) {
        saved = errno;
        syscall(SYS_close, fd);
        errno = saved;
        return -1;
    }
    memcpy((char *)argument + length - sizeof fd, &fd, sizeof fd);
    return result;
}

static int is_claim(uint32_t request)
{
    return request == 0xC250B407 || request == 0xC16CB403 || request == 0xC030B404;
}

static int control(uint32_t handle, uint32_t request, void *argument)
{
    struct ioctl_head head = {request, 0, (uintptr_t)argument};
    struct iovec out[2], in[2];
    uint64_t functions;
    int result;
    if (request == I2C_RDWR)
        return rdwr(handle, &head, argument);
    if (request == I2C_SMBUS)
        return smbus(handle, &head, argument);
    if (_IOC_TYPE(request) == SPI_IOC_MAGIC && !_IOC_NR(request) && _IOC_DIR(request) == _IOC_WRITE)
        return spi_message(handle, &head, argument);
    if (is_claim(request))
        return claim(handle, &head, argument);
    if (_IOC_TYPE(request) == SPI_IOC_MAGIC || _IOC_TYPE(request) == GPIO_MAGIC)
        return plain(handle, &head, argument);
    out[1] = (struct iovec){&head, sizeof head};
    in[1] = (struct iovec){&functions, sizeof functions};
    if (request == I2C_FUNCS && is_bad(argument))
        return refuse(EFAULT);
    result = ask(handle, IOCTL, out, 2, in, 2);
    if (request == I2C_FUNCS && result >= 0)
        *(unsigned long *)argument = (unsigned long)functions;
    return result;
}

static int is_bus_request(uint32_t request)
{
    uint32_t kind = _IOC_TYPE(request);
    return kind == 0x07 || kind == SPI_IOC_MAGIC || kind == GPIO_MAGIC;
}

/* -- What the program calls: descriptors */

static int open_at(int directory, const char *path, int flags, mode_t mode)
{
    char place[PATH_MAX];
    const char *where = moved(directory, path, place);
    NEXT(openat);
    if (where == path)
        return next_openat(directory, path, flags, mode);
    if (is_served(where + folder_length) && !(flags & (O_DIRECTORY | O_PATH)))
        return attach(where + folder_length, flags, OPEN);
    return next_openat(AT_FDCWD, where, flags, mode);
}

#define OPENS(name, large) \
    PUBLIC int name(const char *path, int flags, ...) \
    { \
        va_list more; \
        mode_t mode; \
        va_start(more, flags); \
        mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0; \
        va_end(more); \
        return open_at(AT_FDCWD, path, flags | (large), mode); \
    }
#define OPENS_AT(name, large) \
    PUBLIC int name(int directory, const char *path, int flags, ...) \
    { \
        va_list more; \
        mode_t mode; \
        va_start(more, flags); \
        mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0; \
        va_end(more); \
        return open_at(directory, path, flags | (large), mode); \
    }
OPENS(open, 0)
OPENS(open64, O_LARGEFILE)
OPENS(__open_2, 0)
OPENS(__open64_2, O_LARGEFILE)
OPENS_AT(openat64, O_LARGEFILE)
OPENS_AT(openat, 0)
OPENS_AT(__openat_2, 0)
OPENS_AT(__openat64_2, O_LARGEFILE)

static FILE *open_file(const char *path, const char *mode, FILE *(*next)(const char *, const char *))
{
    char place[PATH_MAX];
    const char *where = moved(AT_FDCWD, path, place);
    FILE *file;
    int fd;
    if (where == path || !is_served(where + folder_length))
        return next(where, mode);
    fd = attach(where + folder_length, strchr(mode, 'e') ? O_CLOEXEC : 0, *mode == 'r' ? OPEN_STREAM : OPEN);
    if (fd < 0)
        return NULL;
    file = fdopen(fd, mode);
    if (!file)
        syscall(SYS_close, fd);
    return file;
}

PUBLIC FILE *fopen(const char *path, const char *mode)
{
    NEXT(fopen);
    return open_file(path, mode, next_fopen);
}

PUBLIC FILE *fopen64(const char *path, const char *mode)
{
    NEXT(fopen64);
    return open_file(path, mode, next_fopen64);
}

static int control_any(int fd, unsigned long request, void *argument)
{
    uint32_t handle = is_bus_request((uint32_t)request) || may_be_ours(fd) ? handle_of(fd) : 0;
    NEXT(ioctl);
    return handle ? control(handle, (uint32_t)request, argument) : next_ioctl(fd, request, argument);
}

#define CONTROLS(name) \
    PUBLIC int name(int fd, unsigned long request, ...) \
    { \
        va_list more; \
        void *argument; \
        va_start(more, request); \
        argument = va_arg(more, void *); \
        va_end(more); \
        return control_any(fd, request, argument); \
    }
CONTROLS(ioctl)
#ifndef __LP64__
CONTROLS(__ioctl_time64)
#endif

PUBLIC ssize_t read(int fd, void *buffer, size_t count)
{
    uint32_t handle = may_be_ours(fd) ? handle_of(fd) : 0, wanted = count > INT_MAX ? INT_MAX : (uint32_t)count;
    struct iovec out[2] = {{0}, {&wanted, sizeof wanted}}, in[2] = {{0}, {buffer, count}};
    NEXT(read);
    return handle ? ask(handle, READ, out, 2, in, 2) : next_read(fd, buffer, count);
}

ssize_t __read_chk(int fd, void *buffer, size_t count, size_t room);
PUBLIC ssize_t __read_chk(int fd, void *buffer, size_t count, size_t room)
{
    if (count > room)
        abort();
    return read(fd, buffer, count);
}

PUBLIC ssize_t write(int fd, const void *buffer, size_t count)
{
    uint32_t handle = may_be_ours(fd) ? handle_of(fd) : 0;
    struct iovec out[2] = {{0}, {(void *)buffer, count > MOST_BYTES ? MOST_BYTES : count}}, in[1];
    NEXT(write);
    return handle ? ask(handle, WRITE, out, 2, in, 1) : next_write(fd, buffer, count);
}

static int copied(int fd, int copy)
{
    if (copy >= 0 && may_be_ours(fd))
        note(copy);
    return copy;
}

PUBLIC int dup(int fd)
{
    NEXT(dup);
    return copied(fd, next_dup(fd));
}

PUBLIC int dup2(int fd, int to)
{
    NEXT(dup2);
    return copied(fd, next_dup2(fd, to));
}

PUBLIC int dup3(int fd, int to, int flags)
{
    NEXT(dup3);
    return copied(fd, next_dup3(fd, to, flags));
}

#define FCNTL(name) \
    PUBLIC int name(int fd, int command, ...) \
    { \
        va_list more; \
        void *argument; \
        int result; \
        NEXT(name); \
        va_start(more, command); \
        argument = va_arg(more, void *); \
        va_end(more); \
        result = next_##name(fd, command, argument); \
        return command == F_DUPFD || command == F_DUPFD_CLOEXEC ? copied(fd, result) : result; \
    }
FCNTL(fcntl)
FCNTL(fcntl64)
#ifndef __LP64__
int __fcntl_time64(int fd, int command, ...);
FCNTL(__fcntl_time64)
#endif

/* -- What it calls: names */

/* The device that a name of /dev has. */
static int device_of(const char *path, unsigned *kind, unsigned *number)
{
    unsigned bus, select;
    if (sscanf(path, "/dev/i2c-%u", &bus) == 1)
        *kind = 89, *number = bus;
    else if (sscanf(path, "/dev/spidev%u.%u", &bus, &select) == 2)
        *kind = 153, *number = bus * 16 + select;
    else if (sscanf(path, "/dev/gpiochip%u", &bus) == 1)
        *kind = 254, *number = bus;
    else
        return 0;
    return 1;
}

/* The name that an open device was opened by. */
static int name_of(uint32_t handle, char *name, size_t room)
{
    struct iovec out[1], in[2] = {{0}, {name, room - 1}};
    int length = ask(handle, NAME, out, 1, in, 2);
    name[length < 0 ? 0 : length] = 0;
    return length > 0;
}

#define PATCH(stat) \
    do { \
        unsigned kind, number; \
        if (device_of(name, &kind, &number)) { \
            (stat)->st_mode = S_IFCHR | 0660; \
            (stat)->st_rdev = makedev(kind, number); \
            (stat)->st_size = 0; \
        } \
    } while (0)

/* A function of the family of stat by a path: how it is declared and called, and the path's directory. */
#define STATS(name_, directory, declared, called) \
    int name_ declared; \
    PUBLIC int name_ declared \
    { \
        char place[PATH_MAX]; \
        const char *own = path, *name; \
        int result; \
        NEXT(name_); \
        path = moved(directory, path, place); \
        if (!next_##name_) \
            return refuse(ENOSYS); \
        result = next_##name_ called; \
        name = path == own ? "" : path + folder_length; \
        if (!result && path != own) \
            PATCH(answer); \
        return result; \
    }
/* And by a descriptor. */
#define STATS_FD(name_, declared, called) \
    int name_ declared; \
    PUBLIC int name_ declared \
    { \
        uint32_t handle = may_be_ours(fd) ? handle_of(fd) : 0; \
        char name[64]; \
        int result; \
        NEXT(name_); \
        if (!next_##name_) \
            return refuse(ENOSYS); \
        result = next_##name_ called; \
        if (!result && handle && name_of(handle, name, sizeof name)) \
            PATCH(answer); \
        return result; \
    }

STATS(stat, AT_FDCWD, (const char *path, struct stat *answer), (path, answer))
STATS(lstat, AT_FDCWD, (const char *path, struct stat *answer), (path, answer))
STATS(stat64, AT_FDCWD, (const char *path, struct stat64 *answer), (path, answer))
STATS(lstat64, AT_FDCWD, (const char *path, struct stat64 *answer), (path, answer))
STATS(__xstat, AT_FDCWD, (int version, const char *path, struct stat *answer), (version, path, answer))
STATS(__lxstat, AT_FDCWD, (int version, const char *path, struct stat *answer), (version, path, answer))
STATS(__xstat64, AT_FDCWD, (int version, const char *path, struct stat64 *answer), (version, path, answer))
STATS(__lxstat64, AT_FDCWD, (int version, const char *path, struct stat64 *answer), (version, path, answer))
STATS(fstatat, fd, (int fd, const char *path, struct stat *answer, int flags), (fd, path, answer, flags))
STATS(fstatat64, fd, (int fd, const char *path, struct stat64 *answer, int flags), (fd, path, answer, flags))
STATS(__fxstatat, fd, (int version, int fd, const char *path, struct stat *answer, int flags),
      (version, fd, path, answer, flags))
STATS(__fxstatat64, fd, (int version, int fd, const char *path, struct stat64 *answer, int flags),
      (version, fd, path, answer, flags))
STATS_FD(fstat, (int fd, struct stat *answer), (fd, answer))
STATS_FD(fstat64, (int fd, struct stat64 *answer), (fd, answer))
STATS_FD(__fxstat, (int version, int fd, struct stat *answer), (version, fd, answer))
STATS_FD(__fxstat64, (int version, int fd, struct stat64 *answer), (version, fd, answer))

PUBLIC int statx(int directory, const char *path, int flags, unsigned mask, struct statx *answer)
{
    char place[PATH_MAX];
    const char *where = moved(directory, path, place);
    unsigned kind, number;
    int result;
    NEXT(statx);
    result = next_statx(directory, where, flags, mask, answer);
    if (!result && where != path && device_of(where + folder_length, &kind, &number)) {
        answer->stx_mode = S_IFCHR | 0660;
        answer->stx_rdev_major = kind;
        answer->stx_rdev_minor = number;
        answer->stx_size = 0;
    }
    return result;
}

PUBLIC int access(const char *path, int mode)
{
    char place[PATH_MAX];
    NEXT(access);
    return next_access(moved(AT_FDCWD, path, place), mode);
}

PUBLIC int chdir(const char *path)
{
    char place[PATH_MAX];
    int result;
    NEXT(chdir);
    result = next_chdir(moved(AT_FDCWD, path, place));
    if (!result)
        look_where_we_are();
    return result;
}

PUBLIC int fchdir(int fd)
{
    int result;
    NEXT(fchdir);
    result = next_fchdir(fd);
    if (!result)
        look_where_we_are();
    return result;
}

PUBLIC int euidaccess(const char *path, int mode)
{
    char place[PATH_MAX];
    NEXT(euidaccess);
    return next_euidaccess(moved(AT_FDCWD, path, place), mode);
}

PUBLIC int eaccess(const char *path, int mode)
{
    return euidaccess(path, mode);
}

PUBLIC int faccessat(int directory, const char *path, int mode, int flags)
{
    char place[PATH_MAX];
    NEXT(faccessat);
    return next_faccessat(directory, moved(directory, path, place), mode, flags);
}

PUBLIC ssize_t readlink(const char *path, char *buffer, size_t room)
{
    char place[PATH_MAX];
    NEXT(readlink);
    return next_readlink(moved(AT_FDCWD, path, place), buffer, room);
}

ssize_t __readlink_chk(const char *path, char *buffer, size_t count, size_t room);
PUBLIC ssize_t __readlink_chk(const char *path, char *buffer, size_t count, size_t room)
{
    if (count > room)
        abort();
    return readlink(path, buffer, count);
}

PUBLIC ssize_t readlinkat(int directory, const char *path, char *buffer, size_t room)
{
    char place[PATH_MAX];
    NEXT(readlinkat);
    return next_readlinkat(directory, moved(directory, path, place), buffer, room);
}

PUBLIC char *realpath(const char *path, char *answer)
{
    char place[PATH_MAX];
    char *found;
    NEXT(realpath);
    found = next_realpath(moved(AT_FDCWD, path, place), answer);
    if (found && folder_length && begins(found, folder) && found[folder_length] == '/')
        memmove(found, found + folder_length, strlen(found) - folder_length + 1);
    return found;
}

char *__realpath_chk(const char *path, char *answer, size_t room);
PUBLIC char *__realpath_chk(const char *path, char *answer, size_t room)
{
    if (room < PATH_MAX)
        abort();
    return realpath(path, answer);
}

PUBLIC char *canonicalize_file_name(const char *path)
{
    return realpath(path, NULL);
}

/* What `ls -l` asks beside. */
#define XATTRS(name, declared, ...) \
    PUBLIC ssize_t name declared \
    { \
        char place[PATH_MAX]; \
        NEXT(name); \
        return next_##name(moved(AT_FDCWD, path, place), __VA_ARGS__); \
    }
XATTRS(getxattr, (const char *path, const char *key, void *value, size_t room), key, value, room)
XATTRS(lgetxattr, (const char *path, const char *key, void *value, size_t room), key, value, room)
XATTRS(listxattr, (const char *path, char *list, size_t room), list, room)
XATTRS(llistxattr, (const char *path, char *list, size_t room), list, room)

/* -- What it calls: lists of /dev, the machine's own without its buses, then the folder's */

static struct listing {
    DIR *dev, *ours;
} listings[16];
static pthread_mutex_t listing_lock = PTHREAD_MUTEX_INITIALIZER;

static DIR *ours_beside(DIR *dev)
{
    DIR *found = NULL;
    pthread_mutex_lock(&listing_lock);
    for (size_t i = 0; dev && i < sizeof listings / sizeof *listings; i++)
        if (listings[i].dev == dev)
            found = listings[i].ours;
    pthread_mutex_unlock(&listing_lock);
    return found;
}

static DIR *listed(DIR *directory)
{
    char path[PATH_MAX];
    int saved = errno;
    NEXT(opendir);
    if (directory && folder_length && folder_of(dirfd(directory), path) && !strcmp(path, "/dev")) {
        snprintf(path, sizeof path, "%s/dev", folder);
        pthread_mutex_lock(&listing_lock);
        for (size_t i = 0; i < sizeof listings / sizeof *listings; i++)
            if (!listings[i].dev) {
                listings[i] = (struct listing){directory, next_opendir(path)};
                break;
            }
        pthread_mutex_unlock(&listing_lock);
    }
    errno = saved;
    return directory;
}

PUBLIC DIR *opendir(const char *path)
{
    char place[PATH_MAX];
    NEXT(opendir);
    return listed(next_opendir(moved(AT_FDCWD, path, place)));
}

PUBLIC DIR *fdopendir(int fd)
{
    NEXT(fdopendir);
    return listed(next_fdopendir(fd));
}

PUBLIC int closedir(DIR *directory)
{
    DIR *ours = NULL;
    NEXT(closedir);
    pthread_mutex_lock(&listing_lock);
    for (size_t i = 0; i < sizeof listings / sizeof *listings; i++)
        if (listings[i].dev == directory) {
            ours = listings[i].ours;
            listings[i] = (struct listing){NULL, NULL};
        }
    pthread_mutex_unlock(&listing_lock);
    if (ours)
        next_closedir(ours);
    return next_closedir(directory);
}

PUBLIC void rewinddir(DIR *directory)
{
    DIR *ours = ours_beside(directory);
    NEXT(rewinddir);
    next_rewinddir(directory);
    if (ours)
        next_rewinddir(ours);
}

/* Whether the machine's own entry is one that the folder's stand for. */
static int is_hidden(const char *name)
{
    char path[NAME_MAX + 6];
    snprintf(path, sizeof path, "/dev/%s", name);
    return is_device(name) || is_link(path);
}

#define READS_DIRECTORIES(name, entry_) \
    PUBLIC struct entry_ *name(DIR *directory) \
    { \
        DIR *ours = ours_beside(directory); \
        struct entry_ *entry; \
        int saved = errno; \
        NEXT(name); \
        do \
            entry = next_##name(directory); \
        while (ours && entry && is_hidden(entry->d_name)); \
        if (entry || !ours || errno != saved) \
            return entry; \
        do \
            entry = next_##name(ours); \
        while (entry && *entry->d_name == '.'); \
        if (entry) \
            entry->d_type = DT_CHR; \
        return entry; \
    }
READS_DIRECTORIES(readdir, dirent)
READS_DIRECTORIES(readdir64, dirent64)

/* The C library's own of these read directories by ways of its own. */
#define SCANS(name, entry_, read_) \
    static int collect_##name(DIR *directory, struct entry_ ***list, int (*wanted)(const struct entry_ *)) \
    { \
        struct entry_ *entry, *copy, **longer; \
        int count = 0; \
        while ((entry = read_(directory))) { \
            if (wanted && !wanted(entry)) \
                continue; \
            longer = realloc(*list, ((size_t)count + 1) * sizeof **list); \
            if (!longer) \
                return -count - 1; \
            *list = longer; \
            copy = malloc(entry->d_reclen > sizeof *copy ? entry->d_reclen : sizeof *copy); \
            if (!copy) \
                return -count - 1; \
            (*list)[count++] = memcpy(copy, entry, entry->d_reclen); \
        } \
        return count; \
    } \
    PUBLIC int name(const char *path, struct entry_ ***answer, int (*wanted)(const struct entry_ *), \
                    int (*order)(const struct entry_ **, const struct entry_ **)) \
    { \
        DIR *directory = opendir(path); \
        struct entry_ **list = NULL; \
        int count; \
        if (!directory) \
            return -1; \
        count = collect_##name(directory, &list, wanted); \
        closedir(directory); \
        if (count < 0) { \
            while (++count) \
                free(list[-count - 1]); \
            free(list); \
            return refuse(ENOMEM); \
        } \
        if (order && count) \
            qsort(list, (size_t)count, sizeof *list, (int (*)(const void *, const void *))(void (*)(void))order); \
        *answer = list ? list : malloc(sizeof *list); \
        return count; \
    }
SCANS(scandir, dirent, readdir)
SCANS(scandir64, dirent64, readdir64)

static void *open_listing(const char *path)
{
    return opendir(path);
}

static void close_listing(void *directory)
{
    closedir(directory);
}

#define GLOBS(name, results, entry_, stat_) \
    static struct entry_ *read_for_##name(void *directory) \
    { \
        return read##entry_##_(directory); \
    } \
    PUBLIC int name(const char *pattern, int flags, int (*failed)(const char *, int), results *found) \
    { \
        NEXT(name); \
        if (!(flags & GLOB_ALTDIRFUNC)) { \
            flags |= GLOB_ALTDIRFUNC; \
            found->gl_opendir = open_listing; \
            found->gl_closedir = close_listing; \
            found->gl_readdir = read_for_##name; \
            found->gl_stat = stat_; \
            found->gl_lstat = l##stat_; \
        } \
        return next_##name(pattern, flags, failed, found); \
    }
#define readdirent_ readdir
#define readdirent64_ readdir64
GLOBS(glob, glob_t, dirent, stat)
GLOBS(glob64, glob64_t, dirent64, stat64)
