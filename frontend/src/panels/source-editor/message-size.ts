/** The server ends the connection at a message of 1 MiB; the rest is room for the message around a text. */
const MAX_BYTES = 1_000_000;

/** Whether a text fits into a message to the server. */
export function isWithinMessageSize(text: string): boolean {
  const length = JSON.stringify(text).length;
  return length * 3 <= MAX_BYTES || (length <= MAX_BYTES && new TextEncoder().encode(JSON.stringify(text)).length <= MAX_BYTES);
}
