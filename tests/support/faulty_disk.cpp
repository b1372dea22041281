#include "tests/support/faulty_disk.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <new>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace recald::testing {
namespace {

constexpr std::size_t kSector = 512;

/// One write, or without bytes the cut to a size.
struct Change {
  std::size_t at;
  std::optional<std::string> bytes;
};

void apply(const Change& change, std::string& contents) {
  if (!change.bytes) return contents.resize(change.at);
  contents.resize(std::max(contents.size(), change.at + change.bytes->size()));
  contents.replace(change.at, change.bytes->size(), *change.bytes);
}

/// Each of its sectors or not.
void apply_torn(const Change& change, std::string& contents, Rng& rng) {
  if (!change.bytes) return apply(change, contents);
  const std::string& bytes = *change.bytes;
  for (std::size_t i = 0; i < bytes.size();) {
    const std::size_t size = std::min(kSector - (change.at + i) % kSector, bytes.size() - i);
    if (rng.below(2) == 0) apply({change.at + i, bytes.substr(i, size)}, contents);
    i += size;
  }
}

/// A file, whatever its name.
struct Inode {
  std::string durable;
  std::vector<Change> unsynced;

  void sync() {
    for (const Change& change : unsynced) apply(change, durable);
    unsynced.clear();
  }

  [[nodiscard]] std::string after_power_cut(Rng& rng) const {
    std::string contents = durable;
    const auto kind = rng.below(4);
    if (kind == 0) return contents;  // nothing of it
    if (kind == 1) {                 // in order, up to some moment
      const std::size_t whole = rng.below(unsynced.size() + 1);
      for (std::size_t i = 0; i < whole; ++i) apply(unsynced[i], contents);
      if (whole < unsynced.size()) apply_torn(unsynced[whole], contents, rng);
      return contents;
    }
    for (const Change& change : unsynced) {  // all of it, or in any order
      const auto fate = kind == 2 ? 1 : rng.below(3);
      if (fate == 1) apply(change, contents);
      if (fate == 2) apply_torn(change, contents, rng);
    }
    return contents;
  }
};

/// A name in the folder: what it stands for, and what it is sure to stand for after a power cut.
struct Entry {
  std::shared_ptr<Inode> now;
  std::shared_ptr<Inode> durable;
};

std::string name_of(const std::string& path) {
  return std::filesystem::path{path}.filename().string();
}

}  // namespace

struct FaultyDisk::Vfs : sqlite3_vfs {
  /// An open file. SQLite allocates it, with room for the real one behind it.
  struct File : sqlite3_file {
    Vfs* vfs;
    std::shared_ptr<Inode> inode;
    std::string name;
    bool syncs_folder;  ///< With its first sync, as SQLite's own file system does for logs.

    sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
    [[nodiscard]] const sqlite3_io_methods& methods() { return *real()->pMethods; }
    [[nodiscard]] int ask(Operation operation) const { return vfs->ask(operation, name); }
  };
  static File& of(sqlite3_file* file) { return *static_cast<File*>(file); }
  static Vfs& of(sqlite3_vfs* vfs) { return *static_cast<Vfs*>(vfs); }

  explicit Vfs(FaultyDisk& disk) : sqlite3_vfs(*sqlite3_vfs_find(nullptr)), owner(disk) {
    pNext = nullptr;
    zName = owner.name_.c_str();
    szOsFile = static_cast<int>(sizeof(File)) + real->szOsFile;
    xOpen = open;
    xDelete = remove;
  }

  [[nodiscard]] int ask(Operation operation, const std::string& name) const {
    return owner.before ? owner.before({operation, name}) : SQLITE_OK;
  }

  static int open(sqlite3_vfs* base, const char* path, sqlite3_file* file, int flags,
                  int* flags_out) {
    Vfs& vfs = of(base);
    file->pMethods = nullptr;
    const std::string at = path == nullptr ? "" : path;
    if (const int refused = vfs.ask(Operation::open, name_of(at))) return refused;
    const bool was_there = std::filesystem::exists(at);
    auto* opened = new (file) File{};
    const int result = vfs.real->xOpen(vfs.real, path, opened->real(), flags, flags_out);
    if (result != SQLITE_OK) {
      opened->~File();
      return result;
    }
    Entry& entry = vfs.entries[at];
    if (!entry.now) {
      entry.now = std::make_shared<Inode>();
      if (was_there) {
        entry.now->durable = read_text(at);
        entry.durable = entry.now;
      }
    }
    opened->pMethods = &kMethods;
    opened->vfs = &vfs;
    opened->inode = entry.now;
    opened->name = name_of(at);
    opened->syncs_folder = (flags & (SQLITE_OPEN_WAL | SQLITE_OPEN_MAIN_JOURNAL)) != 0;
    return SQLITE_OK;
  }

  static int remove(sqlite3_vfs* base, const char* path, int syncs_folder) {
    Vfs& vfs = of(base);
    if (const int refused = vfs.ask(Operation::remove, name_of(path))) return refused;
    const int result = vfs.real->xDelete(vfs.real, path, 0);
    vfs.entries[path].now.reset();
    if (syncs_folder != 0) vfs.sync_folder();
    return result;
  }

  void sync_folder() {
    for (auto& [path, entry] : entries) entry.durable = entry.now;
  }

  static int close(sqlite3_file* file) {
    File& opened = of(file);
    const int result = opened.methods().xClose(opened.real());
    opened.~File();
    return result;
  }
  static int read(sqlite3_file* file, void* bytes, int size, sqlite3_int64 at) {
    File& opened = of(file);
    if (const int refused = opened.ask(Operation::read)) return refused;
    return opened.methods().xRead(opened.real(), bytes, size, at);
  }
  static int write(sqlite3_file* file, const void* bytes, int size, sqlite3_int64 at) {
    File& opened = of(file);
    if (const int refused = opened.ask(Operation::write)) return refused;
    opened.inode->unsynced.push_back(
        {static_cast<std::size_t>(at),
         std::string{static_cast<const char*>(bytes), static_cast<std::size_t>(size)}});
    return opened.methods().xWrite(opened.real(), bytes, size, at);
  }
  static int truncate(sqlite3_file* file, sqlite3_int64 size) {
    File& opened = of(file);
    if (const int refused = opened.ask(Operation::truncate)) return refused;
    opened.inode->unsynced.push_back({static_cast<std::size_t>(size), {}});
    return opened.methods().xTruncate(opened.real(), size);
  }
  static int sync(sqlite3_file* file, int) {
    File& opened = of(file);
    if (const int refused = opened.ask(Operation::sync)) return refused;
    opened.inode->sync();
    if (std::exchange(opened.syncs_folder, false)) opened.vfs->sync_folder();
    return SQLITE_OK;
  }
  static int size(sqlite3_file* file, sqlite3_int64* bytes) {
    return of(file).methods().xFileSize(of(file).real(), bytes);
  }
  static int lock(sqlite3_file* file, int level) {
    return of(file).methods().xLock(of(file).real(), level);
  }
  static int unlock(sqlite3_file* file, int level) {
    return of(file).methods().xUnlock(of(file).real(), level);
  }
  static int check_lock(sqlite3_file* file, int* is_reserved) {
    return of(file).methods().xCheckReservedLock(of(file).real(), is_reserved);
  }
  static int control(sqlite3_file* file, int what, void* argument) {
    if (what == SQLITE_FCNTL_SIZE_HINT) return SQLITE_OK;  // would grow the file behind our back
    return of(file).methods().xFileControl(of(file).real(), what, argument);
  }
  static int sector_size(sqlite3_file* file) {
    return of(file).methods().xSectorSize(of(file).real());
  }
  static int characteristics(sqlite3_file* file) {
    return of(file).methods().xDeviceCharacteristics(of(file).real());
  }
  static int map_shared(sqlite3_file* file, int page, int bytes, int extend,
                        void volatile** mapped) {
    File& opened = of(file);
    if (const int refused = opened.ask(Operation::share)) return refused;
    return opened.methods().xShmMap(opened.real(), page, bytes, extend, mapped);
  }
  static int lock_shared(sqlite3_file* file, int offset, int count, int flags) {
    return of(file).methods().xShmLock(of(file).real(), offset, count, flags);
  }
  static void barrier(sqlite3_file* file) { of(file).methods().xShmBarrier(of(file).real()); }
  static int unmap_shared(sqlite3_file* file, int removes) {
    return of(file).methods().xShmUnmap(of(file).real(), removes);
  }

  static const sqlite3_io_methods kMethods;

  FaultyDisk& owner;
  sqlite3_vfs* real = sqlite3_vfs_find(nullptr);
  std::map<std::string, Entry> entries;  ///< By path.
};

// Version 2: version 3 would be reads that bypass us, mapped into memory.
const sqlite3_io_methods FaultyDisk::Vfs::kMethods{.iVersion = 2,
                                                   .xClose = close,
                                                   .xRead = read,
                                                   .xWrite = write,
                                                   .xTruncate = truncate,
                                                   .xSync = sync,
                                                   .xFileSize = size,
                                                   .xLock = lock,
                                                   .xUnlock = unlock,
                                                   .xCheckReservedLock = check_lock,
                                                   .xFileControl = control,
                                                   .xSectorSize = sector_size,
                                                   .xDeviceCharacteristics = characteristics,
                                                   .xShmMap = map_shared,
                                                   .xShmLock = lock_shared,
                                                   .xShmBarrier = barrier,
                                                   .xShmUnmap = unmap_shared,
                                                   .xFetch = nullptr,
                                                   .xUnfetch = nullptr};

FaultyDisk::FaultyDisk(std::string name)
    : name_(std::move(name)), vfs_(std::make_unique<Vfs>(*this)) {
  if (sqlite3_vfs_register(vfs_.get(), 0) != SQLITE_OK) throw std::runtime_error("no such disk");
}

FaultyDisk::~FaultyDisk() { sqlite3_vfs_unregister(vfs_.get()); }

FaultyDisk::Image FaultyDisk::after_power_cut(Rng& rng) const {
  Image image;
  for (const auto& [path, entry] : vfs_->entries) {
    const bool came_or_went = entry.now != entry.durable;
    const auto& inode = came_or_went && rng.below(2) == 0 ? entry.now : entry.durable;
    if (inode) image[name_of(path)] = inode->after_power_cut(rng);
  }
  return image;
}

void write_image(const FaultyDisk::Image& image, const std::filesystem::path& folder) {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  for (const auto& [name, contents] : image) write_text(folder / name, contents);
}

}  // namespace recald::testing
