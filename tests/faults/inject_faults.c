/* Loaded before the C library, this lets the n-th output call of a program fail, or kills the program there.

   Calls count that write, shorten, synchronise, rename, make or close a file below FAULT_FOLDER. FAULT_AT is the
   call that meets the fault, FAULT_KIND the fault: "error" (that call fails), "full" (from that call on nothing can
   be made or written), "short" (half of what is to be written is, of binary files in whole words, then the disk is
   full), "kill" (the program ends before the call), "signal" (the signal FAULT_SIGNAL comes before the call), "none". Each call leaves a line in the
   file FAULT_TRACE: its name and the file that it meets. Before the first call whose line is FAULT_WAIT the program
   makes a file `waiting` beside that file, and goes on once it is taken away. With FAULT_FLOCK every lock fails with
   that number. With FAULT_CLOCK the clock of the program goes on by so many milliseconds whenever it is read. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

enum verdict { PASS, FAIL, HALF };

static int calls = 0;

static int below_folder(const char *path)
{
    const char *folder = getenv("FAULT_FOLDER");
    return folder != NULL && path != NULL && strstr(path, folder) != NULL;
}

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

/* The name of a file without the word of 16 letters by which a run knows its own: NAME.new for NAME.WORD.new. */
static void plain_name(const char *path, char *name, size_t size)
{
    size_t length;
    snprintf(name, size, "%s", strrchr(path, '/') + 1);
    length = strlen(name);
    if (length < 22 || name[length - 4] != '.' || name[length - 21] != '.') return;
    if (strspn(name + length - 20, "0123456789abcdef") == 16) memmove(name + length - 20, name + length - 3, 4);
}

/* Make a file `waiting` beside that of the call, and wait until somebody has taken it away. */
static void wait_beside(const char *path)
{
    char waiting[4096];
    int descriptor;
    snprintf(waiting, sizeof waiting, "%.*s/waiting", (int)(strrchr(path, '/') - path), path);
    descriptor = NEXT(open)(waiting, O_CREAT | O_WRONLY, 0666);
    if (descriptor >= 0) NEXT(close)(descriptor);
    while (access(waiting, F_OK) == 0) usleep(5000);
}

static void trace(const char *call, const char *path)
{
    static int has_waited = 0;
    const char *file = getenv("FAULT_TRACE"), *wait = getenv("FAULT_WAIT");
    char name[512], words[600];
    FILE *stream;
    plain_name(path, name, sizeof name);
    snprintf(words, sizeof words, "%s %s", call, name);
    stream = file != NULL ? fopen(file, "a") : NULL;
    if (stream != NULL) {
        fprintf(stream, "%s\n", words);
        fclose(stream);
    }
    if (wait == NULL || has_waited || strcmp(wait, words) != 0) return;
    has_waited = 1;
    wait_beside(path);
}

static int is_output(int descriptor, const char *call)
{
    char link[64], path[4096];
    ssize_t length;
    snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    length = readlink(link, path, sizeof path - 1);
    if (length < 0) return 0;
    path[length] = '\0';
    if (!below_folder(path) || (fcntl(descriptor, F_GETFL) & O_ACCMODE) == O_RDONLY) return 0;
    trace(call, path);
    return 1;
}

static int is_output_path(const char *path, const char *call)
{
    if (!below_folder(path)) return 0;
    trace(call, path);
    return 1;
}

/* Count a call; `bytes` are those that it needs on the disk. A word of 8 bytes is written whole or not at all. */
static enum verdict judge(size_t bytes)
{
    const char *kind = getenv("FAULT_KIND");
    int at = getenv("FAULT_AT") != NULL ? atoi(getenv("FAULT_AT")) : 0;
    int number = __atomic_add_fetch(&calls, 1, __ATOMIC_SEQ_CST);
    if (kind == NULL || number < at) return PASS;
    if (strcmp(kind, "full") == 0 && bytes > 0) return FAIL;
    if (number > at) return PASS;
    if (strcmp(kind, "kill") == 0) raise(SIGKILL);
    if (strcmp(kind, "signal") == 0) raise(atoi(getenv("FAULT_SIGNAL")));
    if (strcmp(kind, "error") == 0) return FAIL;
    if (strcmp(kind, "short") == 0) return bytes > 8 ? HALF : FAIL;
    return PASS;
}

static int failed(void)
{
    errno = ENOSPC;
    return -1;
}

ssize_t write(int descriptor, const void *bytes, size_t count)
{
    enum verdict verdict = is_output(descriptor, "write") ? judge(count) : PASS;
    if (verdict == HALF) NEXT(write)(descriptor, bytes, count / 2);
    return verdict == PASS ? NEXT(write)(descriptor, bytes, count) : failed();
}

ssize_t pwrite(int descriptor, const void *bytes, size_t count, off_t offset)
{
    enum verdict verdict = is_output(descriptor, "pwrite") ? judge(count) : PASS;
    if (verdict == HALF) NEXT(pwrite)(descriptor, bytes, count / 16 * 8, offset);
    return verdict == PASS ? NEXT(pwrite)(descriptor, bytes, count, offset) : failed();
}

int fsync(int descriptor)
{
    return is_output(descriptor, "fsync") && judge(0) != PASS ? failed() : NEXT(fsync)(descriptor);
}

int ftruncate(int descriptor, off_t length)
{
    return is_output(descriptor, "ftruncate") && judge(1) != PASS ? failed() : NEXT(ftruncate)(descriptor, length);
}

int close(int descriptor)
{
    int fails = is_output(descriptor, "close") && judge(0) != PASS;
    int outcome = NEXT(close)(descriptor);
    return fails ? failed() : outcome;
}

int rename(const char *from, const char *to)
{
    return is_output_path(to, "rename") && judge(0) != PASS ? failed() : NEXT(rename)(from, to);
}

int flock(int descriptor, int operation)
{
    const char *cause = getenv("FAULT_FLOCK");
    if (cause == NULL) return NEXT(flock)(descriptor, operation);
    errno = atoi(cause);
    return -1;
}

int creat(const char *path, mode_t mode)
{
    return is_output_path(path, "creat") && judge(1) != PASS ? failed() : NEXT(creat)(path, mode);
}

int open(const char *path, int flags, ...)
{
    mode_t mode = 0;
    if (flags & O_CREAT) {
        va_list rest;
        va_start(rest, flags);
        mode = va_arg(rest, mode_t);
        va_end(rest);
        if (is_output_path(path, "open") && judge(1) != PASS) return failed();
    }
    return NEXT(open)(path, flags, mode);
}

int clock_gettime(clockid_t clock, struct timespec *time)
{
    static long long read_times = 0;
    const char *step = getenv("FAULT_CLOCK");
    long long milliseconds;
    if (step == NULL) return NEXT(clock_gettime)(clock, time);
    milliseconds = 1000000 + atoll(step) * __atomic_add_fetch(&read_times, 1, __ATOMIC_SEQ_CST);
    time->tv_sec = milliseconds / 1000;
    time->tv_nsec = milliseconds % 1000 * 1000000;
    return 0;
}
