/** A field of a topic, as users write it: `/joint_states.position[2]`. Names of topics have no dots. */
export interface FieldName {
  topic: string;
  path: string;
}

/** Null if it has no topic or no field. */
export function parseField(text: string): FieldName | null {
  const found = /^\s*\/?([^.\s]+)\.(\S+)\s*$/.exec(text);
  return found ? { topic: `/${found[1] ?? ""}`, path: found[2] ?? "" } : null;
}

export function fieldText({ topic, path }: FieldName): string {
  return `${topic}.${path}`;
}

/** The text of a value beside its series: six digits, no more zeros than needed. */
export function valueText(value: number | null): string {
  if (value === null) return "";
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf";
  return String(Number(value.toPrecision(6)));
}
