/** A line of a diff: its sign, the part that differs from the line it replaces, and the text before and after that. */
export interface DiffLine {
  /** `-`, `+`, `@` or a blank. */
  readonly sign: string;
  readonly before: string;
  readonly difference: string;
  readonly after: string;
}

/** Returns the lines of a unified diff. Where lines replace an equal number of lines, the differing part is marked. */
export function parseDiff(lines: readonly string[]): DiffLine[] {
  const diffLines: DiffLine[] = [];
  for (let index = 0; index < lines.length; ) {
    const removedLines = takeRun(lines, index, "-");
    const addedLines = takeRun(lines, index + removedLines.length, "+");
    if (removedLines.length > 0 && removedLines.length === addedLines.length) {
      const pairs = removedLines.map((line, i) => markDifference(line.slice(1), addedLines[i]?.slice(1) ?? ""));
      diffLines.push(...pairs.map(([removedLine]) => removedLine), ...pairs.map(([, addedLine]) => addedLine));
      index += 2 * removedLines.length;
    } else {
      const line = lines[index] ?? "";
      diffLines.push({ sign: line.slice(0, 1), before: line.slice(1), difference: "", after: "" });
      index += 1;
    }
  }
  return diffLines;
}

function takeRun(lines: readonly string[], start: number, sign: string): readonly string[] {
  let end = start;
  while (lines[end]?.startsWith(sign) === true) end += 1;
  return lines.slice(start, end);
}

function markDifference(oldText: string, newText: string): [DiffLine, DiffLine] {
  const minLength = Math.min(oldText.length, newText.length);
  let [prefixLength, suffixLength] = [0, 0];
  while (prefixLength < minLength && oldText[prefixLength] === newText[prefixLength]) prefixLength += 1;
  while (suffixLength < minLength - prefixLength && oldText.at(-1 - suffixLength) === newText.at(-1 - suffixLength)) suffixLength += 1;
  // Mark complete numbers and words instead of single characters.
  while (isWordCharacter(oldText[prefixLength - 1])) prefixLength -= 1;
  while (isWordCharacter(oldText[oldText.length - suffixLength])) suffixLength -= 1;
  const createLine = (sign: string, text: string): DiffLine => {
    const end = text.length - suffixLength;
    return { sign, before: text.slice(0, prefixLength), difference: text.slice(prefixLength, end), after: text.slice(end) };
  };
  return [createLine("-", oldText), createLine("+", newText)];
}

function isWordCharacter(character: string | undefined): boolean {
  return character !== undefined && /[\w.+-]/.test(character);
}
