/// What waits, who waits and what comes in has a limit: everything of the kind in the sources is in
/// daemon/limits.md, with a limit that its file has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace recald::layout {
namespace {

using ::testing::IsEmpty;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in{file, std::ios::binary};
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string in_tree(const std::string& file) {
  return text_of(std::filesystem::path{RECALD_SOURCE_DIR} / file);
}

using Row = std::vector<std::string>;

/// The rows of the tables of a page, by the heading above them, without their heads.
std::map<std::string, std::vector<Row>> tables_of(const std::string& page) {
  std::map<std::string, std::vector<Row>> tables;
  std::string heading;
  std::istringstream lines{page};
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("## ")) heading = line.substr(3);
    if (!line.starts_with("| ") || line.starts_with("| ---")) continue;
    Row row;
    std::istringstream cells{line.substr(1)};
    for (std::string cell; std::getline(cells, cell, '|');) {
      const auto begin = cell.find_first_not_of(' ');
      const auto end = cell.find_last_not_of(' ');
      row.push_back(begin == std::string::npos ? "" : cell.substr(begin, end - begin + 1));
    }
    tables[heading].push_back(std::move(row));
  }
  for (auto& [name, rows] : tables) rows.erase(rows.begin());
  return tables;
}

/// What stands between backticks in a cell.
std::vector<std::string> quoted_in(const std::string& cell) {
  static const std::regex quoted{"`([^`]+)`"};
  std::vector<std::string> all;
  for (std::sregex_iterator at{cell.begin(), cell.end(), quoted}, end; at != end; ++at) {
    all.push_back((*at)[1]);
  }
  return all;
}

/// The code without what stands behind two slashes.
std::string without_comments(const std::string& code) {
  std::string kept;
  std::istringstream lines{code};
  for (std::string line; std::getline(lines, line);) kept += line.substr(0, line.find("//")) + '\n';
  return kept;
}

bool has_word(const std::string& code, const std::string& begin) {
  for (auto at = code.find(begin); at != std::string::npos; at = code.find(begin, at + 1)) {
    const char before = at == 0 ? ' ' : code[at - 1];
    if (std::isalnum(static_cast<unsigned char>(before)) == 0 && before != '_') return true;
  }
  return false;
}

/// Files of the product in whose code a word begins with one of these.
std::set<std::string> product_files(const std::vector<std::string>& begins) {
  std::set<std::string> found;
  const std::filesystem::path root{RECALD_SOURCE_DIR};
  for (const char* wing : {"core", "adapters", "daemon"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator{root / wing}) {
      const std::string extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".hpp") continue;
      const std::string code = without_comments(text_of(entry.path()));
      if (std::ranges::any_of(begins, [&](const auto& one) { return has_word(code, one); })) {
        found.insert(std::filesystem::relative(entry.path(), root));
      }
    }
  }
  return found;
}

/// Files of a kind without a row, rows without such a file, and limits that the file does not have.
std::vector<std::string> faults(const std::vector<Row>& rows, const std::set<std::string>& files) {
  std::vector<std::string> all;
  std::set<std::string> listed;
  for (const Row& row : rows) {
    const std::string& file = row.at(0);
    listed.insert(file);
    if (!files.contains(file)) all.push_back(file + " is listed and has nothing of the kind");
    std::vector<std::string> limits = quoted_in(row.at(1));
    for (const std::string& more : quoted_in(row.at(2))) limits.push_back(more);
    if (limits.empty()) all.push_back(file + " has a row without a limit");
    // Of a header the limit may be used in its source.
    const std::string code = in_tree(file) + in_tree(file.substr(0, file.rfind('.')) + ".cpp");
    for (const std::string& limit : limits) {
      if (code.find(limit) == std::string::npos) all.push_back(file + " does not have " + limit);
    }
  }
  for (const std::string& file : files) {
    if (!listed.contains(file)) all.push_back(file + " is not listed");
  }
  return all;
}

const std::vector<std::string> kOutbox{": public Outbox", ": public Sink"};
const std::vector<std::string> kBetweenThreads{"std::mutex ", "std::shared_mutex ",
                                               "std::recursive_mutex ", "std::timed_mutex ",
                                               "boost::lockfree"};
const std::vector<std::string> kWaits{"PQconnect",      "PQexec",
                                      "PQprepare",      "PQgetResult",
                                      "PQreset",        "curl_easy_perform",
                                      "curl_multi_",    "modbus_connect(",
                                      "modbus_read",    "modbus_write",
                                      "modbus_receive", "mosquitto_connect_bind",
                                      "mosquitto_loop", "sqlite3_busy_timeout",
                                      "sleep_for(",     "sleep_until(",
                                      "getaddrinfo(",   "popen(",
                                      "std::system(",   "posix_spawn(",
                                      "::poll(",        "::ppoll(",
                                      "::select(",      "::wait4(",
                                      "::waitpid(",     "::accept",
                                      "::recv",         "wait(lock",
                                      "wait_for(lock",  "wait_until(lock",
                                      "std::future",    "LOCK_EX"};

TEST(Limits, EveryOutboxEveryQueueAndEveryWaitHasOne) {
  const auto tables = tables_of(in_tree("daemon/limits.md"));
  EXPECT_THAT(faults(tables.at("Outboxes"), product_files(kOutbox)), IsEmpty());
  EXPECT_THAT(faults(tables.at("Between threads"), product_files(kBetweenThreads)), IsEmpty());
  EXPECT_THAT(faults(tables.at("Calls that wait"), product_files(kWaits)), IsEmpty());
}

TEST(Limits, WhatIsNewAndWhatHasNoLimitIsNamed) {
  EXPECT_THAT(faults({{"core/result.hpp", "nothing", "no limit"},
                      {"core/text/limited.hpp", "texts", "`kNowhere`"}},
                     {"core/result.hpp", "core/new_queue.hpp"}),
              ::testing::ElementsAre("core/result.hpp has a row without a limit",
                                     "core/text/limited.hpp is listed and has nothing of the kind",
                                     "core/text/limited.hpp does not have kNowhere",
                                     "core/new_queue.hpp is not listed"));
}

/// Names of the members that may be texts, at any depth.
void add_texts(const nlohmann::json& schema, std::set<std::string>& texts) {
  if (schema.is_array()) {
    for (const auto& one : schema) add_texts(one, texts);
  }
  if (!schema.is_object()) return;
  for (const auto& [name, value] : schema.items()) {
    const bool is_text = value.is_object() && value.contains("type") &&
                         value["type"].dump().find("\"string\"") != std::string::npos;
    if (is_text) texts.insert(name);
    add_texts(value, texts);
  }
}

TEST(Limits, EveryTextOfARequestAndEveryConstantOfOneIsThere) {
  auto api = nlohmann::json::parse(in_tree("daemon/gateway/serve/openapi.json"));
  std::set<std::string> texts;
  for (const auto& [path, operations] : api["paths"].items()) {
    for (const auto& [method, operation] : operations.items()) {
      if (!operation.contains("requestBody")) continue;
      const std::string body = operation["requestBody"].dump();
      add_texts(operation["requestBody"], texts);
      for (const auto& [name, schema] : api["components"]["schemas"].items()) {
        if (body.find("/schemas/" + name + '"') != std::string::npos) add_texts(schema, texts);
      }
    }
  }
  ASSERT_GE(texts.size(), 5u);
  std::set<std::string> listed;
  static const std::regex place{R"(\b(adapters|core|daemon)/[\w/]+\.hpp|\badapters/[\w/]+\.cpp)"};
  const auto tables = tables_of(in_tree("daemon/limits.md"));
  for (const Row& row : tables.at("Texts that come in")) {
    for (const std::string& text : quoted_in(row.at(0))) listed.insert(text);
    std::smatch file;
    const bool has_file = std::regex_search(row.at(2), file, place);
    for (const std::string& limit : quoted_in(row.at(2))) {
      ASSERT_TRUE(has_file) << row.at(2);
      EXPECT_NE(in_tree(file.str()).find(limit), std::string::npos) << limit;
    }
  }
  EXPECT_THAT(listed, ::testing::IsSupersetOf(texts));
}

}  // namespace
}  // namespace recald::layout
