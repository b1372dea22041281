#include "daemon/gateway/serve/api/csv_answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "adapters/csv/fields.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

std::string in_csv(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string{text};
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += '"';
    field += c;
  }
  return field + '"';
}

std::string field_of(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return in_csv(value.get_ref<const std::string&>());
  if (!value.is_array()) return value.dump();
  std::string joined;
  for (const Json& one : value) joined += (joined.empty() ? "" : "|") + one.get<std::string>();
  return in_csv(joined);
}

std::string in_url(std::string_view text) {
  std::string encoded;
  for (const char c : text) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '_' || c == '~';
    encoded += is_plain ? std::string{c} : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return encoded;
}

std::string address_of_next(http::Request request, const std::string& cursor) {
  request.query["cursor"] = cursor;
  std::string address = request.path;
  char separator = '?';
  for (const auto& [name, value] : request.query) {
    address += separator + in_url(name) + "=" + in_url(value);
    separator = '&';
  }
  return address;
}

}  // namespace

Checked<bool> wants_csv(const http::Request& request) {
  if (const auto format = text_of(request, "format")) {
    if (*format == "csv" || *format == "json") return *format == "csv";
    return refusal(400, "invalid_value",
                   fmt::format("'format' is {}; write csv or json", csv::in_quotes(*format)),
                   "format");
  }
  const std::string_view accept = request.header("accept");
  const std::size_t csv = accept.find("text/csv");
  return csv != std::string_view::npos && csv < accept.find("application/json");
}

http::Response as_csv(const http::Request& request, const http::Response& json,
                      std::span<const CsvColumn> columns) {
  const Json answer = Json::parse(json.body);
  const auto list =
      std::ranges::find_if(answer, [](const Json& member) { return member.is_array(); });
  std::vector<Json::json_pointer> pointers;
  http::Response response{.content_type = "text/csv; charset=utf-8; header=present"};
  for (const CsvColumn& column : columns) {
    response.body += (pointers.empty() ? "" : ",") + std::string{column.name};
    pointers.emplace_back(column.pointer);
  }
  response.body += "\r\n";
  for (const Json& entry : *list) {
    for (std::size_t i = 0; i < pointers.size(); ++i) {
      if (i > 0) response.body += ',';
      if (entry.contains(pointers[i])) response.body += field_of(entry.at(pointers[i]));
    }
    response.body += "\r\n";
  }
  if (const Json& next = answer.at("next"); next.is_string()) {
    response.headers.emplace_back(
        "Link", "<" + address_of_next(request, next.get<std::string>()) + ">; rel=\"next\"");
  }
  return response;
}

}  // namespace recald::daemon
