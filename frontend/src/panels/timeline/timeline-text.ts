import type { HistoryExtent, TimelineTopic } from "../../protocol";

/** The maximum number of topics with a row in the timeline. */
const MAX_TOPIC_ROWS = 12;
const MIN_DENSITY = 0.12;

/** Seconds since the epoch (1973); smaller times are those of a simulation. */
const MIN_CALENDAR_TIME_S = 1e8;

/** Returns `0:07.250 / 1:30`: the elapsed time and the duration. */
export function formatElapsed(elapsed: number, duration: number): string {
  return `${formatMinutes(elapsed, 3)} / ${formatMinutes(duration, duration < 10 ? 3 : 0)}`;
}

/** Returns `1:30 · 45 MB`: the length and the size of the history. */
export function formatExtent({ start, end, size }: HistoryExtent): string {
  return formatAmount(end - start, size);
}

/** Returns `1:30 · 45 MB` for seconds and bytes. */
export function formatAmount(seconds: number, bytes: number): string {
  return `${formatLength(seconds)} · ${formatSize(bytes)}`;
}

/** Returns `45 MB / 1.20 GB` for a number of bytes and their total. */
export function formatBytesOfTotal(bytes: number, totalBytes: number): string {
  return `${formatSize(bytes)} / ${formatSize(totalBytes)}`;
}

/** Returns `1:30` for seconds. */
export function formatLength(seconds: number): string {
  return formatMinutes(seconds, 0);
}

/** Returns `7.3 s` below a minute, otherwise `1:30`. */
export function formatSeconds(seconds: number): string {
  return seconds < 60 ? `${seconds.toFixed(1)} s` : formatLength(seconds);
}

/** Returns `45 kB`, `4.5 MB` or `1.20 GB`. */
export function formatSize(bytes: number): string {
  if (bytes < 1e6) return `${(bytes / 1e3).toFixed(0)} kB`;
  return bytes < 1e9 ? `${(bytes / 1e6).toFixed(bytes < 1e7 ? 1 : 0)} MB` : `${(bytes / 1e9).toFixed(2)} GB`;
}

/** Returns `−0:07.250`: how long ago the displayed moment was. */
export function formatAge(age: number): string {
  return `−${formatMinutes(age, 3)}`;
}

/** Returns the local date and time of day with milliseconds, and the seconds since the epoch. */
export function formatClock(seconds: number): string {
  const date = new Date(seconds * 1000);
  return `${date.toLocaleString()}.${String(date.getMilliseconds()).padStart(3, "0")} (${seconds.toFixed(3)})`;
}

/** Returns `14:03:07.250`, the local time of day, or `0:52.304` for simulated time, which starts at zero. */
export function formatMoment(seconds: number): string {
  if (seconds < MIN_CALENDAR_TIME_S) return formatMinutes(seconds, 3);
  const date = new Date(Math.round(seconds * 1000));
  const parts = [date.getHours(), date.getMinutes(), date.getSeconds()];
  const clock = parts.map((part) => String(part).padStart(2, "0")).join(":");
  return `${clock}.${String(date.getMilliseconds()).padStart(3, "0")}`;
}

/**
 * Returns the density of messages in the parts of a recording, 0 to 1 relative to each topic's densest part; topics
 * with the most messages come first.
 */
export function computeDensities(topics: readonly TimelineTopic[]): number[][] {
  const countedTopics = topics.filter(({ counts }) => counts.length > 0).sort((a, b) => b.count - a.count);
  return countedTopics.slice(0, MAX_TOPIC_ROWS).map(({ counts }) => {
    const maxCount = Math.max(...counts);
    return counts.map((count) => (count === 0 ? 0 : MIN_DENSITY + (1 - MIN_DENSITY) * (count / maxCount)) * 0.6);
  });
}

function formatMinutes(seconds: number, digits: number): string {
  const roundedSeconds = Number(Math.max(0, seconds).toFixed(digits));
  const hours = Math.floor(roundedSeconds / 3600);
  const minutes = Math.floor((roundedSeconds % 3600) / 60);
  const text = (roundedSeconds % 60).toFixed(digits).padStart(digits > 0 ? digits + 3 : 2, "0");
  return hours > 0 ? `${hours}:${String(minutes).padStart(2, "0")}:${text}` : `${minutes}:${text}`;
}
