import type { HistoryExtent, TimelineTopic } from "../../protocol";

/** The maximum number of topics with a row in the timeline. */
const MAX_ROWS = 12;
const MIN_DENSITY = 0.12;

/** Seconds since the epoch (1973); smaller times are those of a simulation. */
const MIN_CALENDAR_TIME = 1e8;

/** Returns `0:07.250 / 1:30`: the elapsed time of the whole. */
export function elapsedText(passed: number, whole: number): string {
  return `${minutesText(passed, 3)} / ${minutesText(whole, whole < 10 ? 3 : 0)}`;
}

/** Returns `1:30 · 45 MB`: the length and the size of the history. */
export function extentText({ start, end, size }: HistoryExtent): string {
  return amountText(end - start, size);
}

/** Returns `1:30 · 45 MB` for seconds and bytes. */
export function amountText(seconds: number, bytes: number): string {
  return `${lengthText(seconds)} · ${sizeText(bytes)}`;
}

/** Returns `45 MB / 1.20 GB` for a number of bytes and their total. */
export function amountOf(bytes: number, whole: number): string {
  return `${sizeText(bytes)} / ${sizeText(whole)}`;
}

/** Returns `1:30` for seconds. */
export function lengthText(seconds: number): string {
  return minutesText(seconds, 0);
}

/** Returns `7.3 s` below a minute, else `1:30`. */
export function secondsText(seconds: number): string {
  return seconds < 60 ? `${seconds.toFixed(1)} s` : lengthText(seconds);
}

/** Returns `45 kB`, `4.5 MB` or `1.20 GB`. */
export function sizeText(bytes: number): string {
  if (bytes < 1e6) return `${(bytes / 1e3).toFixed(0)} kB`;
  return bytes < 1e9 ? `${(bytes / 1e6).toFixed(bytes < 1e7 ? 1 : 0)} MB` : `${(bytes / 1e9).toFixed(2)} GB`;
}

/** Returns `−0:07.250`: how long ago the displayed moment was. */
export function agoText(ago: number): string {
  return `−${minutesText(ago, 3)}`;
}

/** Returns the local date and time of day with milliseconds, and the seconds since the epoch. */
export function clockText(seconds: number): string {
  const date = new Date(seconds * 1000);
  return `${date.toLocaleString()}.${String(date.getMilliseconds()).padStart(3, "0")} (${seconds.toFixed(3)})`;
}

/** Returns `14:03:07.250`, the local time of day, or `0:52.304` for simulated time, which starts at zero. */
export function momentText(seconds: number): string {
  if (seconds < MIN_CALENDAR_TIME) return minutesText(seconds, 3);
  const date = new Date(Math.round(seconds * 1000));
  const parts = [date.getHours(), date.getMinutes(), date.getSeconds()];
  const clock = parts.map((part) => String(part).padStart(2, "0")).join(":");
  return `${clock}.${String(date.getMilliseconds()).padStart(3, "0")}`;
}

/**
 * Returns the density of messages in the parts of a recording, 0 to 1 relative to each topic's densest part; topics
 * with the most messages come first.
 */
export function densities(topics: readonly TimelineTopic[]): number[][] {
  const known = topics.filter(({ counts }) => counts.length > 0).sort((a, b) => b.count - a.count);
  return known.slice(0, MAX_ROWS).map(({ counts }) => {
    const most = Math.max(...counts);
    return counts.map((count) => (count === 0 ? 0 : MIN_DENSITY + (1 - MIN_DENSITY) * (count / most)) * 0.6);
  });
}

function minutesText(seconds: number, digits: number): string {
  const shown = Number(Math.max(0, seconds).toFixed(digits));
  const hours = Math.floor(shown / 3600);
  const rest = Math.floor((shown % 3600) / 60);
  const text = (shown % 60).toFixed(digits).padStart(digits > 0 ? digits + 3 : 2, "0");
  return hours > 0 ? `${hours}:${String(rest).padStart(2, "0")}:${text}` : `${rest}:${text}`;
}
