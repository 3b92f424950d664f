/** A field of a topic, written as `/joint_states.position[2]`. Topic names contain no dots. */
export interface FieldName {
  topic: string;
  path: string;
}

/** Parses a field; returns null if the topic or the field is missing. */
export function parseField(text: string): FieldName | null {
  const match = /^\s*\/?([^.\s]+)\.(\S+)\s*$/.exec(text);
  return match ? { topic: `/${match[1] ?? ""}`, path: match[2] ?? "" } : null;
}

export function formatField({ topic, path }: FieldName): string {
  return `${topic}.${path}`;
}

/** Returns a value with six digits and no trailing zeros, for the legend of a plot. */
export function formatValue(value: number | null): string {
  if (value === null) return "";
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf";
  return String(Number(value.toPrecision(6)));
}
