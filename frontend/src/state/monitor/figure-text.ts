const UNITS = ["B/s", "KB/s", "MB/s", "GB/s"];

/** Returns bytes per second in a suitable unit, in steps of 1000 like `ros2 topic bw`. */
export function formatBandwidth(bytes: number): string {
  let [value, unit] = [bytes, 0];
  while (value >= 1000 && unit < UNITS.length - 1) {
    value /= 1000;
    unit++;
  }
  const digits = unit === 0 || value >= 100 ? 0 : value >= 10 ? 1 : 2;
  return `${value.toFixed(digits)} ${UNITS[unit] ?? ""}`;
}

/** Returns Hz with a sensible number of digits. */
export function formatRate(rate: number): string {
  return rate >= 100 ? rate.toFixed(0) : rate >= 10 ? rate.toFixed(1) : rate.toFixed(2);
}

/** Returns the time of day with milliseconds; `time` in seconds since the epoch. */
export function formatClock(time: number): string {
  const date = new Date(time * 1000);
  const pad = (value: number, digits: number): string => String(value).padStart(digits, "0");
  const clock = [date.getHours(), date.getMinutes(), date.getSeconds()].map((field) => pad(field, 2)).join(":");
  return `${clock}.${pad(date.getMilliseconds(), 3)}`;
}
