/**
 * Raised when a mesh cannot be drawn, with a reason in the user's language. Other errors of readers and browsers are
 * not meant for users.
 */
export class MeshError extends Error {}

/** Returns a count with spaces between thousands: 40 000 000. */
export function formatCount(count: number): string {
  return count.toLocaleString("en").replaceAll(",", " ");
}

/** Returns a size in B, kB or MB. */
export function formatBytes(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  return bytes < 1e6 ? `${Math.round(bytes / 1e3)} kB` : `${(bytes / 1e6).toFixed(bytes < 1e7 ? 1 : 0)} MB`;
}

/** Returns names in quotes, separated by commas. */
export function quoteNames(names: readonly string[]): string {
  return names.map((name) => `'${name}'`).join(", ");
}
