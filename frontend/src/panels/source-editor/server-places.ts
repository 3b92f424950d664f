import type { Text } from "@codemirror/state";

/** A range of a text, as in the protocol of language servers. */
export interface ServerRange {
  readonly start: { line: number; character: number };
  readonly end: { line: number; character: number };
}

/** Returns the position of a place in a text; one beyond the text is its end. */
export function offsetOf(text: Text, { line, character }: ServerRange["start"]): number {
  if (line >= text.lines) return text.length;
  const textLine = text.line(line + 1);
  return Math.min(textLine.from + character, textLine.to);
}

/** Returns the place of a position in a text. */
export function serverPositionOf(text: Text, position: number): ServerRange["start"] {
  const line = text.lineAt(position);
  return { line: line.number - 1, character: position - line.from };
}

/** Returns the text of a range. */
export function textOfRange(text: Text, { start, end }: ServerRange): string {
  return text.sliceString(offsetOf(text, start), offsetOf(text, end));
}

/** Returns the path of a file's URI; null for other URIs. */
export function pathOf(uri: string): string | null {
  if (!uri.startsWith("file:///")) return null;
  const path = decodeURIComponent(uri.slice("file://".length));
  return /^\/[A-Za-z]:/.test(path) ? path.slice(1) : path;
}
