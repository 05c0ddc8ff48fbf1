// Preloaded into a program (LD_PRELOAD), makes a chosen allocation or system call fail:
//
//   HBAR_FAULT=malloc:7    the 7th allocation returns nothing
//   HBAR_FAULT=malloc+:7   and so do all that follow
//   HBAR_FAULT=write:2     the 2nd write to a file fails; likewise fsync, rename, fchmod, mkstemp,
//                          close
//   HBAR_FAULT=short:1     every write takes 100 bytes at most, and every other is interrupted
//   HBAR_FAULT_COUNT=FILE  at the end, how many of each there were
//
// It must not allocate itself, hence C's functions alone.
#include <dlfcn.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>

extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
}

namespace {

enum Kind { kMalloc, kWrite, kFsync, kRename, kFchmod, kMkstemp, kClose, kKinds };
constexpr const char* kNames[kKinds] = {"malloc", "write",   "fsync", "rename",
                                        "fchmod", "mkstemp", "close"};
std::atomic<long> counts[kKinds];

struct Fault {
  int kind = -1;
  long place = 0;
  bool onwards = false;
  bool shortened = false;
};

Fault read_fault() {
  Fault fault;
  const char* text = getenv("HBAR_FAULT");
  const char* colon = text == nullptr ? nullptr : strchr(text, ':');
  if (colon == nullptr) {
    return fault;
  }
  fault.place = atol(colon + 1);
  fault.onwards = colon[-1] == '+';
  const auto length = static_cast<size_t>(colon - text - (fault.onwards ? 1 : 0));
  fault.shortened = strncmp(text, "short", length) == 0;
  for (int kind = 0; kind < kKinds; ++kind) {
    if (strlen(kNames[kind]) == length && strncmp(text, kNames[kind], length) == 0) {
      fault.kind = kind;
    }
  }
  return fault;
}

const Fault& fault() {
  static Fault known;
  static std::atomic<bool> read = false;
  if (!read) {
    known = read_fault();
    read = true;
  }
  return known;
}

/// Set when every library has initialised itself, which some of them do not survive without memory;
/// the program's own objects are still to come.
std::atomic<bool> started = false;

bool fails(Kind kind) {
  if (!started) {
    return false;
  }
  const long count = ++counts[kind];
  return fault().kind == kind &&
         (count == fault().place || (fault().onwards && count > fault().place));
}

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

__attribute__((destructor)) void tell_counts() {
  const char* path = getenv("HBAR_FAULT_COUNT");
  if (path == nullptr) {
    return;
  }
  char text[200];
  int length = 0;
  for (int kind = 0; kind < kKinds; ++kind) {
    length += snprintf(text + length, sizeof(text) - static_cast<size_t>(length), "%s %ld\n",
                       kNames[kind], counts[kind].load());
  }
  const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  static_cast<void>(!next<ssize_t (*)(int, const void*, size_t)>("write")(
      file, text, static_cast<size_t>(length)));
}

}  // namespace

extern "C" {

// What the program calls when its libraries are ready (glibc, csu/libc-start.c).
int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(),
                      void (*fini)(), void (*rtld_fini)(), void* stack_end) {
  auto* real = next<decltype(&__libc_start_main)>("__libc_start_main");
  started = true;
  return real(main, argc, argv, init, fini, rtld_fini, stack_end);
}

void* malloc(size_t size) {
  if (fails(kMalloc)) {
    errno = ENOMEM;
    return nullptr;
  }
  return __libc_malloc(size);
}

void* calloc(size_t count, size_t size) {
  if (fails(kMalloc)) {
    errno = ENOMEM;
    return nullptr;
  }
  return __libc_calloc(count, size);
}

void* realloc(void* old, size_t size) {
  if (fails(kMalloc)) {
    errno = ENOMEM;
    return nullptr;
  }
  return __libc_realloc(old, size);
}

void* memalign(size_t alignment, size_t size) {
  if (fails(kMalloc)) {
    errno = ENOMEM;
    return nullptr;
  }
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(size_t alignment, size_t size) { return memalign(alignment, size); }

int posix_memalign(void** out, size_t alignment, size_t size) {
  void* found = memalign(alignment, size);
  if (found == nullptr) {
    return ENOMEM;
  }
  *out = found;
  return 0;
}

// Standard streams are left alone: those are a terminal's or a pipe's.
ssize_t write(int file, const void* bytes, size_t size) {
  static auto* real = next<ssize_t (*)(int, const void*, size_t)>("write");
  if (file > STDERR_FILENO) {
    if (fails(kWrite)) {
      errno = ENOSPC;
      return -1;
    }
    if (fault().shortened) {
      if (counts[kWrite] % 2 == 1) {
        errno = EINTR;
        return -1;
      }
      size = size < 100 ? size : 100;
    }
  }
  return real(file, bytes, size);
}

int fsync(int file) {
  static auto* real = next<int (*)(int)>("fsync");
  if (fails(kFsync)) {
    errno = EIO;
    return -1;
  }
  return real(file);
}

int rename(const char* from, const char* to) {
  static auto* real = next<int (*)(const char*, const char*)>("rename");
  if (fails(kRename)) {
    errno = EACCES;
    return -1;
  }
  return real(from, to);
}

int fchmod(int file, mode_t mode) {
  static auto* real = next<int (*)(int, mode_t)>("fchmod");
  if (fails(kFchmod)) {
    errno = EPERM;
    return -1;
  }
  return real(file, mode);
}

int mkstemp(char* name) {
  static auto* real = next<int (*)(char*)>("mkstemp");
  if (fails(kMkstemp)) {
    errno = EMFILE;
    return -1;
  }
  return real(name);
}

int close(int file) {
  static auto* real = next<int (*)(int)>("close");
  const int result = real(file);
  if (file > STDERR_FILENO && fails(kClose)) {
    errno = EIO;
    return -1;
  }
  return result;
}
}
