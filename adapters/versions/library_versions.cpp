#include "adapters/versions/library_versions.hpp"

#include <curl/curl.h>
#include <fmt/core.h>
#include <modbus/modbus.h>
#include <mosquitto.h>
#include <openssl/crypto.h>
#include <spdlog/version.h>
#include <sqlite3.h>
#include <zlib.h>

#include <Eigen/Core>
#include <boost/version.hpp>

#include "adapters/postgres/connection.hpp"

namespace recald {

std::vector<LibraryVersion> library_versions() {
  return {
      {"libmodbus", fmt::format("{}.{}.{}", libmodbus_version_major, libmodbus_version_minor,
                                libmodbus_version_micro)},
      {"SQLite", sqlite3_libversion()},
      {"OpenSSL", OpenSSL_version(OPENSSL_FULL_VERSION_STRING)},
      {"libcurl", curl_version_info(CURLVERSION_NOW)->version},
      {"libmosquitto",
       fmt::format("{}.{}.{}", LIBMOSQUITTO_MAJOR, LIBMOSQUITTO_MINOR, LIBMOSQUITTO_REVISION)},
      {"libpq", postgres::library_version()},
      {"zlib", zlibVersion()},
      {"fmt",
       fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
      {"spdlog", fmt::format("{}.{}.{}", SPDLOG_VER_MAJOR, SPDLOG_VER_MINOR, SPDLOG_VER_PATCH)},
      {"Eigen",
       fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"Boost", fmt::format("{}.{}.{}", BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000,
                            BOOST_VERSION % 100)},
  };
}

}  // namespace recald
