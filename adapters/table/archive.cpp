#include "adapters/table/archive.hpp"

#include <zip.h>

#include "adapters/system/files/regular_file.hpp"

namespace recald::table {

struct Archive::Handle {
  zip_t* zip;
  std::string name;

  Handle(zip_t* opened, std::string file) : zip{opened}, name{std::move(file)} {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { zip_discard(zip); }
};

Result<Archive> Archive::open(const std::filesystem::path& file) {
  TRY(system::require_file(file, "workbook"));
  int code = 0;
  zip_t* zip = zip_open(file.c_str(), ZIP_RDONLY, &code);
  if (zip == nullptr) {
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string reason = zip_error_strerror(&error);
    zip_error_fini(&error);
    const bool is_other = code == ZIP_ER_NOZIP || code == ZIP_ER_INCONS;
    return failure(is_other ? ErrorCode::malformed : ErrorCode::io_failed,
                   "workbook '" + file.string() + "' is not .xlsx: " + reason);
  }
  Archive archive;
  archive.handle_ = std::make_shared<Handle>(zip, file.string());
  return archive;
}

bool Archive::has(const std::string& entry) const {
  return zip_name_locate(handle_->zip, entry.c_str(), 0) >= 0;
}

Result<csv::ByteSource> Archive::bytes_of(const std::string& entry) const {
  zip_file_t* opened = zip_fopen(handle_->zip, entry.c_str(), 0);
  if (opened == nullptr) {
    return failure(ErrorCode::malformed, "workbook '" + handle_->name + "' has no readable '" +
                                             entry + "': " + zip_strerror(handle_->zip));
  }
  // The archive stays open as long as one of its entries does.
  const std::shared_ptr<zip_file_t> file{opened, zip_fclose};
  return csv::ByteSource{
      [handle = handle_, file, entry](char* buffer, std::size_t size) -> Result<std::size_t> {
        const zip_int64_t got = zip_fread(file.get(), buffer, size);
        if (got < 0) {
          return failure(ErrorCode::io_failed, "workbook '" + handle->name + "' is damaged: '" +
                                                   entry + "' cannot be unpacked");
        }
        return static_cast<std::size_t>(got);
      }};
}

}  // namespace recald::table
