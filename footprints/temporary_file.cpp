#include "footprints/temporary_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <set>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>

namespace edgesplat {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTag = ".edgesplat-", kEnding = ".tmp";
constexpr std::size_t kLongestName = 200;  ///< bytes of the target's name in the temporary one, which may have 255
constexpr int kAttempts = 1000;

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
std::mutex signals_mutex;
std::atomic<int> deferring = 0;
static_assert(std::atomic<int>::is_always_lock_free);
std::array<struct sigaction, kSignals.size()> handled_before{};
volatile std::sig_atomic_t pending = 0;

[[noreturn]] void throw_errno(int error) {
    throw std::system_error(error, std::generic_category());
}

/// Whether a name is a TemporaryFile's: it ends in .edgesplat-DIGITS-DIGITS.tmp.
bool is_temporary(std::string_view name) {
    const std::size_t tag = name.rfind(kTag);
    if (!name.starts_with('.') || !name.ends_with(kEnding) || tag == std::string_view::npos) return false;
    name.remove_suffix(kEnding.size());
    if (name.size() <= tag + kTag.size()) return false;
    name.remove_prefix(tag + kTag.size());
    const std::size_t dash = name.find('-');
    const auto digits = [](std::string_view text) {
        return !text.empty() && std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
    };
    return dash != std::string_view::npos && digits(name.substr(0, dash)) && digits(name.substr(dash + 1));
}

enum class Lock { Taken, Held, None };

/// The lock belongs to the open file. fcntl's other locks belong to the process and end with any close() of the file.
/// It is also independent of flock, which HDF5 uses for the files that it writes.
Lock lock(int descriptor) {
    struct flock whole {};
    whole.l_type = F_WRLCK;
    whole.l_whence = SEEK_SET;
    if (fcntl(descriptor, F_OFD_SETLK, &whole) == 0) return Lock::Taken;
    return errno == EAGAIN || errno == EACCES ? Lock::Held : Lock::None;
}

void remove_if_stale(const fs::path& path) {
    const int descriptor = open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) return;
    struct stat opened {
    }, named{};
    // The writer may have renamed the file since it was opened.
    if (lock(descriptor) == Lock::Taken && fstat(descriptor, &opened) == 0 && lstat(path.c_str(), &named) == 0 &&
        S_ISREG(opened.st_mode) && opened.st_ino == named.st_ino && opened.st_dev == named.st_dev)
        unlink(path.c_str());
    close(descriptor);
}

/// Whether this process uses a folder for the first time.
bool first_visit(const fs::path& folder) {
    static std::mutex mutex;
    // Never destroyed: a static renderer writes its cache when the program ends.
    static auto& visited = *new std::set<std::tuple<std::string, dev_t, ino_t>>;
    struct stat found {};
    if (stat(folder.c_str(), &found) != 0) return false;
    const std::lock_guard guard(mutex);
    return visited.emplace(folder.string(), found.st_dev, found.st_ino).second;
}

fs::path folder_of(const fs::path& target) {
    return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

}  // namespace

void write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) throw_errno(errno);
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

DeferSignals::DeferSignals() {
    const std::lock_guard guard(signals_mutex);
    if (deferring++ > 0) return;
    pending = 0;
    struct sigaction note {};
    note.sa_handler = [](int signal) { pending = signal; };
    sigemptyset(&note.sa_mask);
    note.sa_flags = SA_RESTART;
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        sigaction(kSignals.at(i), nullptr, &handled_before.at(i));
        if (handled_before.at(i).sa_handler != SIG_IGN) sigaction(kSignals.at(i), &note, nullptr);
    }
}

DeferSignals::~DeferSignals() {
    int noted = 0;
    {
        const std::lock_guard guard(signals_mutex);
        if (--deferring > 0) return;
        for (std::size_t i = 0; i < kSignals.size(); ++i)
            sigaction(kSignals.at(i), &handled_before.at(i), nullptr);
        noted = pending;
    }
    if (noted != 0) raise(noted);
}

bool DeferSignals::any() noexcept {
    return deferring > 0;
}

TemporaryFile::TemporaryFile(const fs::path& target) : target_(target) {
    const fs::path folder = folder_of(target);
    if (first_visit(folder)) remove_stale_temporaries(folder);
    for (int attempt = 0; attempt < kAttempts; ++attempt)
        if (open_new()) return;
    throw_errno(EEXIST);
}

bool TemporaryFile::open_new() {
    static std::atomic<unsigned> counter = 0;
    const std::string name = fmt::format(".{}{}{}-{}{}", target_.filename().string().substr(0, kLongestName), kTag,
                                         getpid(), counter++, kEnding);
    path_ = target_.parent_path() / name;
    descriptor_ = open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
        const int error = errno;
        path_.clear();
        if (error == EEXIST) return false;
        throw_errno(error);
    }
    // Before it was locked, another process may have removed the file as stale.
    struct stat opened {};
    if (lock(descriptor_) != Lock::Held && fstat(descriptor_, &opened) == 0 && opened.st_nlink > 0) return true;
    path_.clear();
    close();
    return false;
}

TemporaryFile::~TemporaryFile() {
    if (!path_.empty()) unlink(path_.c_str());
    close();
}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : target_(std::move(other.target_)),
      path_(std::exchange(other.path_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

void TemporaryFile::close() noexcept {
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
}

void TemporaryFile::write(std::string_view bytes) {
    write_all(descriptor_, bytes);
}

void TemporaryFile::sync() {
    if (fsync(descriptor_) != 0) throw_errno(errno);
}

void TemporaryFile::rename_to_target() {
    if (std::rename(path_.c_str(), target_.c_str()) != 0) throw_errno(errno);
    path_.clear();
    close();
}

void remove_stale_temporaries(const fs::path& folder) noexcept {
    try {
        std::error_code error;
        for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
            if (is_temporary(it->path().filename().string())) remove_if_stale(it->path());
    } catch (...) {  // NOLINT(bugprone-empty-catch): a later call removes the rest
    }
}

}  // namespace edgesplat
