/** A line of a diff: its sign, and the text before, in and after the part that differs from the line it replaces. */
export interface DiffLine {
  /** `-`, `+`, `@` or a blank. */
  readonly sign: string;
  readonly before: string;
  readonly changed: string;
  readonly after: string;
}

/** Returns the lines of a unified diff. Where lines replace an equal number of lines, the differing part is marked. */
export function diffLines(lines: readonly string[]): DiffLine[] {
  const result: DiffLine[] = [];
  for (let at = 0; at < lines.length; ) {
    const removed = run(lines, at, "-");
    const added = run(lines, at + removed.length, "+");
    if (removed.length > 0 && removed.length === added.length) {
      const pairs = removed.map((line, i) => pair(line.slice(1), added[i]?.slice(1) ?? ""));
      result.push(...pairs.map(([old]) => old), ...pairs.map(([, now]) => now));
      at += 2 * removed.length;
    } else {
      const line = lines[at] ?? "";
      result.push({ sign: line.slice(0, 1), before: line.slice(1), changed: "", after: "" });
      at += 1;
    }
  }
  return result;
}

function run(lines: readonly string[], from: number, sign: string): readonly string[] {
  let to = from;
  while (lines[to]?.startsWith(sign) === true) to += 1;
  return lines.slice(from, to);
}

function pair(old: string, now: string): [DiffLine, DiffLine] {
  const least = Math.min(old.length, now.length);
  let [head, tail] = [0, 0];
  while (head < least && old[head] === now[head]) head += 1;
  while (tail < least - head && old.at(-1 - tail) === now.at(-1 - tail)) tail += 1;
  // Mark complete numbers and words instead of single characters.
  while (isWordCharacter(old[head - 1])) head -= 1;
  while (isWordCharacter(old[old.length - tail])) tail -= 1;
  const line = (sign: string, text: string): DiffLine => {
    const end = text.length - tail;
    return { sign, before: text.slice(0, head), changed: text.slice(head, end), after: text.slice(end) };
  };
  return [line("-", old), line("+", now)];
}

function isWordCharacter(character: string | undefined): boolean {
  return character !== undefined && /[\w.+-]/.test(character);
}
