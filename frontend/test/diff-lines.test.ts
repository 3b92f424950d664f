import { describe, expect, it } from "vitest";
import { parseDiff } from "../src/panels/editing/diff-lines";

function formatDiff(...lines: string[]): string[] {
  return parseDiff(lines).map(({ sign, before, difference, after }) => `${sign}${before}[${difference}]${after}`);
}

describe("the lines of a diff", () => {
  it("mark whole numbers that differ", () => {
    expect(formatDiff("@@ -3 +3 @@", " <a/>", '-<origin xyz="0.1 0 0.05"/>', '+<origin xyz="0.1 0 0.052"/>', " <b/>")).toEqual([
      "@@ -3 +3 @@[]",
      " <a/>[]",
      '-<origin xyz="0.1 0 [0.05]"/>',
      '+<origin xyz="0.1 0 [0.052]"/>',
      " <b/>[]",
    ]);
  });

  it("mark additions where nothing was removed", () => {
    expect(formatDiff("-<link><a/></link>", "+<link><o/><a/></link>")).toEqual(["-<link><[a]/></link>", "+<link><[o/><a]/></link>"]);
    expect(formatDiff('-<o x="1"/>', '+<o x="1" y="-2"/>')).toEqual(['-<o x="1"[]/>', '+<o x="1"[ y="-2"]/>']);
  });

  it("are paired if equally many lines replace others", () => {
    expect(formatDiff("-a 1", "-b 2", "+a 3", "+b 4")).toEqual(["-a [1]", "-b [2]", "+a [3]", "+b [4]"]);
    expect(formatDiff("-a 1", "+a 1", "+b 2")).toEqual(["-a 1[]", "+a 1[]", "+b 2[]"]);
    expect(formatDiff("+a", "-b", "+c")).toEqual(["+a[]", "-[b]", "+[c]"]);
  });
});
