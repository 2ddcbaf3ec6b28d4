// Whole files in and out, safely. The order temporary file, fsync, rename is what keeps the old
// file intact on a full disk or a crash.
#include "tracer/file_io.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tracer/error.h"

namespace tracer {
namespace {

// An open file that is closed at the end of the scope.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }

  int value() const { return value_; }
  bool is_open() const { return value_ >= 0; }
  // False if the file system reports a late write error.
  bool close() {
    const int value = value_;
    value_ = -1;
    return value < 0 || ::close(value) == 0;
  }

 private:
  int value_;
};

std::string reason(int error) {
  return std::error_code(error, std::generic_category()).message();
}

[[noreturn]] void throw_unwritable(const std::filesystem::path& file, size_t bytes, int error) {
  const char* advice = error == ENOSPC || error == EDQUOT
                           ? "free some space or choose another place"
                           : "choose another place";
  throw Error(fmt::format("{}: cannot write {} bytes: {}; {}", file.string(), bytes, reason(error),
                          advice));
}

// 0, or the error number.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(size_t(written));
  }
  return 0;
}

// A name beside the target that no other file has, opened; `name` receives it.
int open_temporary(const std::filesystem::path& target, mode_t mode, std::string& name) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    // The target's name is shortened: with the ending it must stay within 255 bytes.
    name =
        (target.parent_path() /
         fmt::format(".{}.{}-{}.tmp", target.filename().string().substr(0, 200), getpid(), attempt))
            .string();
    const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
  return -1;
}

void flush_folder(const std::filesystem::path& file) {
  const std::string folder = file.has_parent_path() ? file.parent_path().string() : ".";
  const Descriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (descriptor.is_open()) fsync(descriptor.value());
}

void write_device(const std::filesystem::path& file, std::string_view bytes) {
  const Descriptor descriptor(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
  if (!descriptor.is_open()) throw_unwritable(file, bytes.size(), errno);
  if (const int error = write_all(descriptor.value(), bytes)) {
    throw_unwritable(file, bytes.size(), error);
  }
}

}  // namespace

std::string read_file(const std::filesystem::path& file, uint64_t max_bytes) {
  const std::string name = file.string();
  // Not blocking: opening a pipe without a writer must not hang.
  const Descriptor descriptor(::open(name.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!descriptor.is_open()) {
    if (errno == ENOENT) throw Error(name + ": the file does not exist");
    throw Error(fmt::format("{}: cannot be opened: {}", name, reason(errno)));
  }
  struct stat status {};
  if (fstat(descriptor.value(), &status) != 0) {
    throw Error(fmt::format("{}: cannot be read: {}", name, reason(errno)));
  }
  if (S_ISDIR(status.st_mode)) throw Error(name + ": is a folder, not a file");
  if (!S_ISREG(status.st_mode)) {
    throw Error(name + ": is not a regular file (it is a pipe, socket or device)");
  }
  if (uint64_t(status.st_size) > max_bytes) {
    throw Error(fmt::format("{}: has {} bytes; the limit for this kind of file is {}", name,
                            status.st_size, max_bytes));
  }
  std::string bytes(size_t(status.st_size), '\0');
  size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t count = ::read(descriptor.value(), bytes.data() + filled, bytes.size() - filled);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw Error(fmt::format("{}: cannot be read: {}", name, reason(errno)));
    if (count == 0) break;  // somebody made it shorter meanwhile
    filled += size_t(count);
  }
  bytes.resize(filled);
  return bytes;
}

void write_file_atomically(const std::filesystem::path& file, std::string_view bytes) {
  std::error_code ignored;
  std::filesystem::path target = file;
  if (std::filesystem::is_symlink(file, ignored)) {
    target = std::filesystem::weakly_canonical(file, ignored);
    if (ignored) target = file;
  }
  mode_t mode = 0666;  // less the user's mask
  struct stat status {};
  const bool replaces = stat(target.c_str(), &status) == 0;
  if (replaces) {
    if (S_ISDIR(status.st_mode)) {
      throw Error(file.string() + ": cannot be written: it is a folder; give a file name");
    }
    if (!S_ISREG(status.st_mode)) return write_device(target, bytes);
    if (access(target.c_str(), W_OK) != 0) throw_unwritable(file, bytes.size(), errno);
    mode = status.st_mode & 07777;
  }

  std::string temporary;
  Descriptor descriptor(open_temporary(target, mode, temporary));
  if (!descriptor.is_open()) throw_unwritable(file, bytes.size(), errno);
  int error = write_all(descriptor.value(), bytes);
  if (!error && replaces && fchmod(descriptor.value(), mode) != 0) error = errno;
  if (!error && fsync(descriptor.value()) != 0) error = errno;
  if (!descriptor.close() && !error) error = errno;
  if (!error && rename(temporary.c_str(), target.c_str()) != 0) error = errno;
  if (error) {
    unlink(temporary.c_str());
    throw_unwritable(file, bytes.size(), error);
  }
  flush_folder(target);
}

}  // namespace tracer
