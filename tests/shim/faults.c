/* Loaded before the C library (LD_PRELOAD) it strikes the program coralpipe at its N-th operation on files: by SIGKILL, or
 * as a disk that is full from there on. Operations are counted over all threads: open for writing, write (twice: before
 * it, and after half of its bytes), close, rename, unlink, link, mkdir, rmdir, ftruncate. Environment:
 *   FAULT_AT      N, from 1
 *   FAULT_KIND    "kill" or "full"
 *   FAULT_REPORT  a file that is made when it strikes
 *   FAULT_LINKS   "no": a disk without hard links
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

enum strike { PASS, FIRST, LATER };

static atomic_long count;
static long at;
static int kills, fills, no_links;

__attribute__((constructor)) static void begin(void) {
    const char *n = getenv("FAULT_AT"), *kind = getenv("FAULT_KIND"), *links = getenv("FAULT_LINKS");
    if (strcmp(program_invocation_short_name, "coralpipe") != 0) return;
    at = n ? atol(n) : 0;
    kills = at > 0 && kind && strcmp(kind, "kill") == 0;
    fills = at > 0 && kind && strcmp(kind, "full") == 0;
    no_links = links && strcmp(links, "no") == 0;
}

static void report(void) {
    const char *path = getenv("FAULT_REPORT");
    int fd = path ? syscall(SYS_openat, AT_FDCWD, path, O_CREAT | O_WRONLY, 0644) : -1;
    if (fd >= 0) syscall(SYS_close, fd);
}

static void end(void) {
    report();
    syscall(SYS_kill, getpid(), SIGKILL);
    for (;;) pause();
}

/* An operation that takes space or only changes names: a full disk refuses the former. */
static enum strike operation(int takes_space) {
    if (!kills && !(fills && takes_space)) return PASS;
    long n = atomic_fetch_add(&count, 1) + 1;
    if (kills && n == at) end();
    if (!fills || n < at) return PASS;
    if (n == at) report();
    return n == at ? FIRST : LATER;
}

static int full(void) {
    errno = ENOSPC;
    return -1;
}

/* A file that is written, not a stream of the test's. */
static int is_watched(int fd) {
    struct stat found;
    if (fd <= 2 || !(kills || fills) || fstat(fd, &found) != 0 || !S_ISREG(found.st_mode)) return 0;
    return (fcntl(fd, F_GETFL) & O_ACCMODE) != O_RDONLY;
}

static int opened(int (*with)(int, const char *, int, ...), int folder, const char *path, int flags, mode_t mode) {
    int writes = (flags & O_ACCMODE) != O_RDONLY || (flags & O_CREAT);
    if (writes && operation(1) != PASS) return full();
    return with(folder, path, flags, mode);
}

#define MODE(flags) \
    mode_t mode = 0; \
    if ((flags) & (O_CREAT | O_TMPFILE)) { va_list rest; va_start(rest, flags); mode = va_arg(rest, int); va_end(rest); }

int open(const char *path, int flags, ...) { MODE(flags) return opened(REAL(openat), AT_FDCWD, path, flags, mode); }
int open64(const char *path, int flags, ...) { MODE(flags) return opened(REAL(openat64), AT_FDCWD, path, flags, mode); }
int openat(int folder, const char *path, int flags, ...) { MODE(flags) return opened(REAL(openat), folder, path, flags, mode); }
int openat64(int folder, const char *path, int flags, ...) { MODE(flags) return opened(REAL(openat64), folder, path, flags, mode); }

ssize_t write(int fd, const void *bytes, size_t size) {
    ssize_t (*real)(int, const void *, size_t) = REAL(write);
    if (!is_watched(fd)) return real(fd, bytes, size);
    if (operation(1) != PASS) return full();
    if (size < 2) return real(fd, bytes, size);
    if (kills && atomic_load(&count) + 1 == at) {
        real(fd, bytes, size / 2);
        operation(1);
    }
    switch (operation(1)) {
    case FIRST: return real(fd, bytes, size / 2);
    case LATER: return full();
    default: return real(fd, bytes, size);
    }
}

ssize_t writev(int fd, const struct iovec *parts, int n) {
    if (is_watched(fd) && operation(1) != PASS) return full();
    return REAL(writev)(fd, parts, n);
}

int close(int fd) {
    if (is_watched(fd)) operation(0);
    return REAL(close)(fd);
}

int rename(const char *from, const char *to) { return operation(1) != PASS ? full() : REAL(rename)(from, to); }
int mkdir(const char *path, mode_t mode) { return operation(1) != PASS ? full() : REAL(mkdir)(path, mode); }
int unlink(const char *path) { operation(0); return REAL(unlink)(path); }
int unlinkat(int folder, const char *path, int flags) { operation(0); return REAL(unlinkat)(folder, path, flags); }
int rmdir(const char *path) { operation(0); return REAL(rmdir)(path); }
int ftruncate(int fd, off_t size) { operation(0); return REAL(ftruncate)(fd, size); }
int ftruncate64(int fd, off64_t size) { operation(0); return REAL(ftruncate64)(fd, size); }

static int link_refused(void) {
    errno = EPERM;
    return no_links;
}
int link(const char *from, const char *to) {
    if (link_refused()) return -1;
    return operation(1) != PASS ? full() : REAL(link)(from, to);
}
int linkat(int a, const char *from, int b, const char *to, int flags) {
    if (link_refused()) return -1;
    return operation(1) != PASS ? full() : REAL(linkat)(a, from, b, to, flags);
}
