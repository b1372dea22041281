// Times as the clocks at the site show them, wherever the browser is. All are in seconds since 1970.
import { monthName } from "./format.js";

const minute = 60;
const hour = 60 * minute;
const day = 24 * hour;
const steps = [
  ...[5, 15, 30].map((n) => n * minute),
  ...[1, 3, 6, 12].map((n) => n * hour),
  ...[1, 2, 7, 14].map((n) => n * day),
];
const monthSteps = [1, 3, 6, 12, 24, 48, 120];

const twoDigits = (n) => String(n).padStart(2, "0");
const dateOf = (wall) => new Date(wall * 1000);
const dayText = (wall) => dateOf(wall).toISOString().slice(0, 10);
const clockText = (wall) => dateOf(wall).toISOString().slice(11, 16);
const isMidnight = (wall) => wall % day === 0;

function offsetText(offset) {
  const size = Math.abs(offset) / minute;
  return `${offset < 0 ? "−" : "+"}${twoDigits(Math.floor(size / 60))}:${twoDigits(size % 60)}`;
}

/**
 * @param offsets  [since, local minus UTC] of each stretch of time, in order; the first also holds
 *                 before it begins.
 */
export class SiteTime {
  #offsets;

  constructor(offsets) {
    this.#offsets = offsets;
  }

  #offsetAt(t) {
    const over = this.#offsets.filter(([since]) => since <= t);
    return (over.at(-1) ?? this.#offsets[0])[1];
  }

  /** What the clocks at the site show, as seconds since their 1970. */
  #wall(t) {
    return t + this.#offsetAt(t);
  }

  /** The first instant that shows this, or the jump if the clocks skip it. */
  #instant(wall) {
    let t = wall - this.#offsets[0][1];
    for (const [since, offset] of this.#offsets.slice(1)) {
      if (t < since) break;
      t = Math.max(wall - offset, since);
    }
    return t;
  }

  /** "2024-03-30 08:00 to 09:00 −05:00"; of whole days "2024-03-30", "2024-03-01 to 2024-03-31". */
  spanText(from, to) {
    const [begin, end] = [this.#wall(from), this.#wall(to)];
    const last = dayText(end - 1);
    if (isMidnight(begin) && isMidnight(end)) {
      return dayText(begin) === last ? last : `${dayText(begin)} to ${last}`;
    }
    const until = dayText(begin) === last ? clockText(end) : `${dayText(end)} ${clockText(end)}`;
    return `${dayText(begin)} ${clockText(begin)} to ${until} ${offsetText(this.#offsetAt(from))}`;
  }

  #stepped(from, to, step) {
    const ticks = [];
    for (let wall = Math.ceil(this.#wall(from) / step) * step; ; wall += step) {
      const at = this.#instant(wall);
      if (at > to) return ticks;
      // An hour that the clocks skip begins where the next one does.
      if (at >= from && at !== ticks.at(-1)) ticks.push(at);
    }
  }

  #months(from, to, every) {
    const first = dateOf(this.#wall(from));
    const ticks = [];
    let month = first.getUTCFullYear() * 12 + first.getUTCMonth();
    for (month = Math.ceil(month / every) * every; ; month += every) {
      const at = this.#instant(Date.UTC(Math.floor(month / 12), month % 12) / 1000);
      if (at > to) return ticks;
      if (at >= from) ticks.push(at);
    }
  }

  /** Round local times, `most` of them or fewer, and how each is labelled. */
  ticks(from, to, most) {
    for (const step of steps) {
      if ((to - from) / step > most + 1) continue;
      const ticks = this.#stepped(from, to, step);
      if (ticks.length <= most) return { ticks, label: (t) => this.#tickText(t) };
    }
    for (const every of monthSteps) {
      if ((to - from) / (every * 28 * day) > 1.2 * most + 1) continue;
      const ticks = this.#months(from, to, every);
      if (ticks.length <= most) return { ticks, label: (t) => this.#monthText(t, every) };
    }
    return { ticks: [], label: () => "" };
  }

  #tickText(t) {
    const wall = this.#wall(t);
    const date = dateOf(wall);
    return isMidnight(wall)
      ? `${date.getUTCDate()} ${monthName(date.getUTCMonth() + 1)}`
      : clockText(wall);
  }

  #monthText(t, every) {
    const date = dateOf(this.#wall(t));
    const year = date.getUTCFullYear();
    return every % 12 === 0 ? `${year}` : `${monthName(date.getUTCMonth() + 1)} ${year}`;
  }
}
