/* An I2C adapter for user-mode Linux whose wire is a program: what i2c-dev lets through is read from a character device
 * by whoever plays the bus, and the answer is written there.
 *
 * Debian ships that kernel without headers. So this is linked with Debian's own i2c-stub.ko, which has all that depends
 * on how the kernel was configured: the module's description, and an adapter that only lacks plain I2C. What is declared
 * here is the beginning of the kernel's structures, the same for long.
 */
typedef unsigned long size_t;
typedef long ssize_t;

struct message {
    unsigned short address, flags, length;
    unsigned char *buffer;
};
struct algorithm {
    int (*transfer)(void *, struct message *, int);
    void *transfer_atomic, *smbus, *smbus_atomic;
    unsigned (*functionality)(void *);
    void *rest[4];
};
extern struct adapter {
    void *owner;
    unsigned class;
    const struct algorithm *algorithm;
} stub_adapter;
struct completion {
    unsigned done;
    unsigned long queue[7];
};

int i2c_add_adapter(struct adapter *);
int __register_chrdev(unsigned, unsigned, unsigned, const char *, const void *);
unsigned long raw_copy_to_user(void *, const void *, unsigned long);
unsigned long raw_copy_from_user(void *, const void *, unsigned long);
void __init_swait_queue_head(void *, const char *, void *);
void complete(struct completion *);
void wait_for_completion(struct completion *);
int wait_for_completion_interruptible(struct completion *);

enum { READ = 1, EINTR = 4, EINVAL = 22, EFAULT = 14, ENODEV = 19, MAJOR = 240 };

static struct completion asked, answered;
static struct message *messages;
static int count, result, served, ending;

static int transfer(void *adapter, struct message *all, int number)
{
    if (!served)
        return -ENODEV;
    messages = all;
    count = number;
    complete(&asked);
    wait_for_completion(&answered);
    messages = 0;
    return result;
}

static unsigned functionality(void *adapter)
{
    return 0x0EFF0001;
}

static const struct algorithm algorithm = {.transfer = transfer, .functionality = functionality};

static int open(void *inode, void *file)
{
    served = 1;
    return 0;
}

static int release(void *inode, void *file)
{
    served = 0;
    if (messages) {
        result = -ENODEV;
        complete(&answered);
    }
    return 0;
}

/* Gives the next call: how many messages, their heads, and the bytes to write. Nothing once the server is to end. */
static ssize_t read(void *file, char *buffer, size_t room, long long *position)
{
    char *end = buffer;
    unsigned long failed = 0;
    if (wait_for_completion_interruptible(&asked))
        return -EINTR;
    if (ending) {
        ending = 0;
        return 0;
    }
    failed |= raw_copy_to_user(end, &count, 4);
    end += 4;
    for (int i = 0; i < count; i++, end += 8) {
        unsigned short head[4] = {messages[i].address, messages[i].flags, messages[i].length,
                                  messages[i].flags & READ ? 0 : messages[i].length};
        failed |= raw_copy_to_user(end, head, sizeof head);
    }
    for (int i = 0; i < count; i++)
        if (!(messages[i].flags & READ)) {
            failed |= raw_copy_to_user(end, messages[i].buffer, messages[i].length);
            end += messages[i].length;
        }
    return failed ? -EFAULT : end - buffer;
}

/* Takes the result and the bytes that were read. Nothing at all ends the server's read. */
static ssize_t write(void *file, const char *buffer, size_t length, long long *position)
{
    const char *end = buffer + 4;
    if (!length) {
        ending = 1;
        complete(&asked);
        return 0;
    }
    if (!messages || length < 4 || raw_copy_from_user(&result, buffer, 4))
        return -EINVAL;
    for (int i = 0; result >= 0 && i < count; i++)
        if (messages[i].flags & READ) {
            if (raw_copy_from_user(messages[i].buffer, end, messages[i].length))
                return -EFAULT;
            end += messages[i].length;
        }
    complete(&answered);
    return (ssize_t)length;
}

/* The kernel's file_operations, of which these are filled: read, write, open and release. */
static void *operations[48] = {[2] = read, [3] = write, [14] = open, [16] = release};

int init_module(void)
{
    __init_swait_queue_head(asked.queue, "asked", 0);
    __init_swait_queue_head(answered.queue, "answered", 0);
    stub_adapter.algorithm = &algorithm;
    if (__register_chrdev(MAJOR, 0, 1, "simulated-adapter", operations))
        return -EINVAL;
    return i2c_add_adapter(&stub_adapter);
}

void cleanup_module(void)
{
}
