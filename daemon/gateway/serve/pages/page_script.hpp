/// The pages' script. All that is read is there without it; it renews what changes, and presses
/// buttons.
#pragma once

#include <string_view>

namespace recald::daemon {

inline constexpr std::string_view kPageScript = R"js("use strict";
const renewEvery_ms = 10000;

/** The same page as it is now, unless somebody is reading with the keyboard or the tab is hidden. */
async function renew() {
  const main = document.querySelector("main");
  const says = document.getElementById("said")?.textContent; // what a button has just done
  if (document.hidden || says || main.contains(document.activeElement)) return;
  try {
    const answer = await fetch(location.href);
    if (!answer.ok) return;
    const page = new DOMParser().parseFromString(await answer.text(), "text/html");
    main.replaceWith(page.querySelector("main"));
    document.querySelector("footer").replaceWith(page.querySelector("footer"));
  } catch {
    // The daemon is restarting; the next time may do.
  }
}

async function post(button) {
  const said = document.getElementById("said");
  button.disabled = true;
  said.textContent = "…";
  try {
    const answer = await fetch(button.dataset.post, {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: button.dataset.body,
    });
    if (answer.ok) return location.reload();
    said.textContent = (await answer.json()).error.message;
  } catch {
    said.textContent = "The daemon does not answer.";
  }
  button.disabled = false;
}

document.addEventListener("click", (event) => {
  const button = event.target.closest("button[data-post]");
  if (button) post(button);
});
if (document.body.dataset.live !== undefined) setInterval(renew, renewEvery_ms);
)js";

}  // namespace recald::daemon
