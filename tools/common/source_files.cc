#include "tools/common/source_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/visible_text.h"
#include "tools/common/descriptor.h"
#include "tools/common/files.h"

namespace tools {
namespace {

constexpr size_t kShown = 10;  // files that differ
constexpr int kFolder = O_RDONLY | O_DIRECTORY | O_CLOEXEC;

base::Error unwritable(const std::string& path, int code) {
  const bool odd = code == ELOOP || code == ENOTDIR;
  const char* const why =
      odd ? "a link, or a file in the place of a folder, is in the way" : std::strerror(code);
  return {base::Refusal::kFileUnwritable, base::visible(path) + ": " + why};
}

// A file by the folder that it lies in.
struct Place {
  Descriptor folder{-1};  // -1: there is no such folder
  std::string name;
};

class Folder {
 public:
  explicit Folder(const std::string& path) : path_(path), root_(::open(path.c_str(), kFolder)) {}

  base::Status make() {
    std::error_code error;
    std::filesystem::create_directories(path_, error);
    root_ = Descriptor(::open(path_.c_str(), kFolder));
    if (root_.fd < 0) return unwritable(path_, errno);
    return base::Ok{};
  }

  base::Result<SourceState> look_at(const ir::SourceText& source) const {
    if (root_.fd < 0) return SourceState::kNew;
    base::Result<Place> place = find(source.path, false);
    if (!place.ok()) return place.error();
    if (place->folder.fd < 0) return SourceState::kNew;
    constexpr int kReadOnly = O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
    const Descriptor file(::openat(place->folder.fd, place->name.c_str(), kReadOnly));
    struct stat info;
    if (file.fd < 0 && errno == ENOENT) return SourceState::kNew;
    if (file.fd < 0) return unwritable(in_folder(source.path), errno);
    if (::fstat(file.fd, &info) != 0 || !S_ISREG(info.st_mode)) {
      return unwritable(in_folder(source.path), EEXIST);
    }
    return holds(file.fd, source.text) ? SourceState::kSame : SourceState::kReplaced;
  }

  // All or nothing, as write_file().
  base::Status write(const ir::SourceText& source) const {
    base::Result<Place> place = find(source.path, true);
    if (!place.ok()) return place.error();
    const std::string path = in_folder(source.path);
    const std::string temporary = ".stc.tmp" + std::to_string(::getpid());
    const int folder = place->folder.fd;
    const Descriptor file(::openat(folder, temporary.c_str(),
                                   O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
    if (file.fd < 0) return unwritable(path, errno);
    base::Status written = write_all(file.fd, path, base::as_bytes(source.text));
    if (written.ok() && (::fsync(file.fd) != 0 ||
                         ::renameat(folder, temporary.c_str(), folder, place->name.c_str()) != 0)) {
      written = unwritable(path, errno);
    }
    if (!written.ok()) ::unlinkat(folder, temporary.c_str(), 0);
    return written;
  }

  std::string in_folder(const std::string& path) const {
    return (std::filesystem::path(path_) / path).string();
  }

 private:
  // Folders on the way are made if wanted.
  base::Result<Place> find(const std::string& path, bool make) const {
    Place place{Descriptor(::fcntl(root_.fd, F_DUPFD_CLOEXEC, 0)), {}};
    size_t begin = 0;
    for (size_t slash = path.find('/'); slash != std::string::npos; slash = path.find('/', begin)) {
      const std::string part = path.substr(begin, slash - begin);
      if (make) ::mkdirat(place.folder.fd, part.c_str(), 0777);
      Descriptor next(::openat(place.folder.fd, part.c_str(), kFolder | O_NOFOLLOW));
      if (next.fd < 0 && (make || errno != ENOENT)) {
        return unwritable(in_folder(path.substr(0, slash)), errno);
      }
      place.folder = std::move(next);
      if (place.folder.fd < 0) return place;
      begin = slash + 1;
    }
    place.name = path.substr(begin);
    return place;
  }

  static bool holds(int fd, const std::string& text) {
    std::string there(text.size() + 1, '\0');
    size_t used = 0;
    for (;;) {
      const ssize_t n = ::read(fd, there.data() + used, there.size() - used);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return false;
      used += static_cast<size_t>(n);
      if (n == 0 || used == there.size()) break;
    }
    return used == text.size() && there.compare(0, used, text) == 0;
  }

  std::string path_;
  Descriptor root_;
};

base::Error differ(const Folder& folder, const std::vector<std::string>& paths) {
  std::string text = "nothing was written, because files there differ";
  for (size_t i = 0; i < paths.size() && i < kShown; ++i) {
    text += (i == 0 ? ": " : ", ") + base::visible(folder.in_folder(paths[i]));
  }
  if (paths.size() > kShown) text += " and " + std::to_string(paths.size() - kShown) + " more";
  return {base::Refusal::kSourceDiffers,
          text + "; name another folder, or replace them by --overwrite"};
}

}  // namespace

const char* source_state_name(SourceState state) {
  static constexpr const char* kNames[] = {"new", "same", "replaced"};
  return kNames[static_cast<size_t>(state)];
}

base::Result<std::vector<SourceState>> write_sources(const std::vector<ir::SourceText>& sources,
                                                     const std::string& folder, bool overwrite) {
  Folder place(folder);
  std::vector<SourceState> states;
  std::vector<std::string> different;
  for (const ir::SourceText& source : sources) {
    base::Result<SourceState> state = place.look_at(source);
    if (!state.ok()) return state.error();
    states.push_back(*state);
    if (*state == SourceState::kReplaced) different.push_back(source.path);
  }
  if (!overwrite && !different.empty()) return differ(place, different);
  if (base::Status made = place.make(); !made) return made.error();
  for (size_t i = 0; i < sources.size(); ++i) {
    if (states[i] == SourceState::kSame) continue;
    if (base::Status written = place.write(sources[i]); !written) return written.error();
  }
  return states;
}

}  // namespace tools
