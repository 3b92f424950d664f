/**
 * An error that says in the user's language why a mesh cannot be drawn. Other errors of readers and browsers are not for
 * users.
 */
export class MeshError extends Error {}

/** A count with a space between thousands: 40 000 000. */
export function countText(count: number): string {
  return count.toLocaleString("en").replaceAll(",", " ");
}

/** A size in bytes, kB or MB. */
export function bytesText(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  return bytes < 1e6 ? `${Math.round(bytes / 1e3)} kB` : `${(bytes / 1e6).toFixed(bytes < 1e7 ? 1 : 0)} MB`;
}

/** Names in quotes, with commas. */
export function quoted(names: readonly string[]): string {
  return names.map((name) => `'${name}'`).join(", ");
}
