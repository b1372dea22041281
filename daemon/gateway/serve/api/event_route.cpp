#include <charconv>
#include <nlohmann/json.hpp>

#include "adapters/csv/fields.hpp"
#include "daemon/gateway/serve/api/api.hpp"
#include "daemon/gateway/serve/api/json_answer.hpp"
#include "daemon/gateway/serve/api/parameters.hpp"
#include "daemon/gateway/serve/api/shapes.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;
using metering::Instant;

/// "2026-03-01T00:00:00Z/2": two events of that second were sent, and all before it. New events
/// come in front and do not move the cursor.
struct EventCursor {
  Instant time = Instant::max();
  int sent = 0;
};

Checked<EventCursor> cursor_of(const http::Request& request) {
  const auto text = text_of(request, "cursor");
  if (!text) return EventCursor{};
  EventCursor cursor;
  const std::size_t slash = std::min(text->find('/'), text->size());
  const auto time = csv::parse_timestamp(text->substr(0, slash));
  const char* end = text->data() + text->size();
  const auto [stop, error] =
      std::from_chars(text->data() + std::min(slash + 1, text->size()), end, cursor.sent);
  if (!time || error != std::errc{} || stop != end || cursor.sent < 0) {
    return refusal(400, "invalid_value", "'cursor' is not one from a 'next' of this list",
                   "cursor");
  }
  cursor.time = *time;
  return cursor;
}

}  // namespace

http::Response get_events(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {"from", "to", "limit", "cursor"}); !checked) {
    return checked.error();
  }
  const auto span = span_of(request, served.calendar);
  if (!span) return span.error();
  const auto limit = limit_of(request);
  if (!limit) return limit.error();
  const auto cursor = cursor_of(request);
  if (!cursor) return cursor.error();

  Json events = Json::array();
  Json next;
  std::size_t bytes = 0;
  EventCursor at;  // how many events of which second were passed
  const auto read =
      served.store.for_each_event(std::min(cursor->time, span->end), [&](const StoreEvent& event) {
        at = event.time == at.time ? EventCursor{at.time, at.sent + 1} : EventCursor{event.time, 1};
        if (event.time < span->begin) return false;
        const bool was_sent = event.time == cursor->time && at.sent <= cursor->sent;
        if (was_sent || !span->contains(event.time)) return true;
        if (std::ssize(events) == *limit || bytes > kEventsBytesMax) {
          next = metering::to_string(event.time) + "/" + std::to_string(at.sent - 1);
          return false;
        }
        bytes += event.text.size();
        events.push_back(event_json(event));
        return true;
      });
  if (!read) return refusal(read.error()).value();
  return json_answer({{"events", events}, {"next", next}});
}

}  // namespace recald::daemon
