/// The pages' style sheet. Colours have a contrast of 4.5 to 1 and more, by day and by
/// night.
#pragma once

#include <string_view>

namespace recald::daemon {

inline constexpr std::string_view kPageStyle = R"css(:root {
  color-scheme: light dark;
  --ink: #1b1b1b; --paper: #ffffff; --line: #c4c4c4;
  --muted: #595959; --good: #0b6b2e; --warn: #7a4b00; --bad: #a3151c; --link: #0b4f9c;
  --model-fill: #c2d3e6; --zoomed: #0b4f9c26;
  /* What the zoomable charts call them. */
  --page: var(--paper); --axis: var(--line); --grid: var(--line); --model-line: var(--link);
}
@media (prefers-color-scheme: dark) {
  :root {
    --ink: #ececec; --paper: #161616; --line: #4a4a4a;
    --muted: #b0b0b0; --good: #6fd392; --warn: #f0b95a; --bad: #ff9a94; --link: #8fc1ff;
    --model-fill: #344152; --zoomed: #8fc1ff33;
  }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 1rem/1.5 system-ui, sans-serif; }
header, main, footer { max-width: 72rem; margin: 0 auto; padding: 0.5rem 1rem; }
h1 { font-size: 1.6rem; margin: 0.5rem 0 0; }
h2, p.caption { font-size: 1.15rem; font-weight: 600; text-align: left; }
p.caption { margin: 1.4rem 0 0.2rem; }
ul { list-style: none; padding: 0; margin: 0; }
table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; vertical-align: top; padding: 0.35rem 0.8rem 0.35rem 0;
  border-bottom: 1px solid var(--line); }
tbody th { font-weight: 600; }
th.number, td.number { text-align: right; font-variant-numeric: tabular-nums; }
.scroll { overflow-x: auto; }
@media (max-width: 40rem) {
  .labelled, .labelled tbody, .labelled tr, .labelled th, .labelled td { display: block; }
  .labelled thead { display: none; }
  .labelled tr { padding: 0.5rem 0; border-bottom: 1px solid var(--line); }
  .labelled th, .labelled td, .labelled td.number { padding: 0.1rem 0; border: 0; text-align: left;
    overflow-wrap: anywhere; }
  .labelled td::before { content: attr(data-label) ": "; color: var(--muted); }
}
.site { font-weight: 600; margin: 0; }
nav a[aria-current] { color: var(--ink); font-weight: 600; text-decoration: none; }
.filter { display: flex; flex-wrap: wrap; gap: 0.5rem 1rem; align-items: baseline; margin: 0.6rem 0; }
input, select, button { font: inherit; color: inherit; background: var(--paper);
  border: 1px solid var(--muted); border-radius: 0.2rem; padding: 0.2rem 0.4rem; max-width: 100%; }
.charts { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(22rem, 100%), 1fr));
  gap: 0.5rem 1.5rem; }
figure { margin: 0; }
.chart { display: block; overflow: visible; font-size: 12px; fill: var(--muted); }
.chart-grid { stroke: var(--line); stroke-width: 1; }
.chart-line, .chart-mark { fill: none; stroke: var(--link); stroke-width: 1.5; vector-effect: non-scaling-stroke; }
.chart-mark { stroke: var(--ink); stroke-width: 4; }
.chart-band { fill: var(--link); fill-opacity: 0.25; stroke: none; }
.plot { height: 280px; }
.plot text { user-select: none; }
@media (scripting: enabled) { .zoomable { min-height: 320px; } } /* Nothing moves when it changes. */
@media print {
  .zoomable { min-height: 0; }
  .plot, .plot > div, .plot svg { position: static !important; width: 100% !important;
    height: auto !important; }
}
.muted { color: var(--muted); }
.good { color: var(--good); }
.warn { color: var(--warn); }
.bad { color: var(--bad); }
a { color: var(--link); padding: 0.3rem 0.6rem 0.3rem 0; display: inline-block; }
a:focus-visible { outline: 3px solid currentColor; outline-offset: 2px; }
)css";

}  // namespace recald::daemon
