import type { ParameterKind } from "../../protocol";

/** Returns a parameter's value as text: arrays as a list in brackets, with strings in quotes. */
export function formatParameter(kind: ParameterKind, values: readonly string[]): string {
  if (!kind.endsWith("_array")) return values[0] ?? "";
  const texts = kind === "string_array" ? values.map((value) => JSON.stringify(value)) : values;
  return `[${texts.join(", ")}]`;
}

/** Parses a text into values, with optional brackets and quotes; returns null if quotes are not closed. */
export function parseParameter(kind: ParameterKind, text: string): string[] | null {
  if (!kind.endsWith("_array")) return [text];
  const content = text.trim().replace(/^\[/, "").replace(/\]$/, "").trim();
  if (content === "") return [];
  const items = /^(?:[^",]*|\s*"(?:[^"\\]|\\.)*"\s*)(?:,(?:[^",]*|\s*"(?:[^"\\]|\\.)*"\s*))*$/.test(content)
    ? (content.match(/"(?:[^"\\]|\\.)*"|[^,"\s][^,"]*/g) ?? [])
    : null;
  if (items === null) return null;
  try {
    return items.map((item) => (item.startsWith('"') ? (JSON.parse(item) as string) : item.trim()));
  } catch {
    return null;
  }
}
