import { EditorState, type TransactionSpec } from "@codemirror/state";
import { describe, expect, it } from "vitest";
import { findSmallestChange, toText } from "../src/panels/source-editor/document-changes";
import { detectIndentation, languageOf } from "../src/panels/source-editor/languages";
import { isWithinMessageSize } from "../src/panels/source-editor/message-size";
import { parseHex, toHex, decodeTokens } from "../src/panels/source-editor/server-meanings";
import { pathOf, offsetOf, textOfRange } from "../src/panels/source-editor/server-places";
import { SourceDocument } from "../src/panels/source-editor/source-document";

const TEXT = "<robot>\n  <link name='a'/>\n  <link name='b'/>\n</robot>\n";

function documentOf(text = TEXT): SourceDocument {
  return new SourceDocument("/ws/a.urdf", "file:///ws/a.urdf", 1, EditorState.create({ doc: text }));
}

function apply(document: SourceDocument, spec: TransactionSpec | null): void {
  if (spec) document.record(document.state.update(spec));
}

/** Replaces a part of the text, as a user does. */
function typeText(document: SourceDocument, oldText: string, newText: string): void {
  const start = document.state.doc.toString().indexOf(oldText);
  apply(document, { changes: { from: start, to: start + oldText.length, insert: newText } });
}

function readText(document: SourceDocument): string {
  return document.state.doc.toString();
}

describe("a document", () => {
  it("is unsaved from a change until it is written or the change is taken back", () => {
    const document = documentOf();
    expect(document.isUnsaved).toBe(false);
    typeText(document, "'a'", "'c'");
    expect(document.isUnsaved).toBe(true);
    typeText(document, "'c'", "'a'");
    expect(document.isUnsaved).toBe(false);
    typeText(document, "'a'", "'c'");
    expect(document.beginWriting()).toBe(TEXT.replace("'a'", "'c'"));
    typeText(document, "'b'", "'d'");
    document.endWriting(2);
    expect([document.isUnsaved, document.version, document.savedText.toString()]).toEqual([true, 2, TEXT.replace("'a'", "'c'")]);
  });

  it("stays unsaved if it was not written", () => {
    const document = documentOf();
    typeText(document, "'a'", "'c'");
    document.beginWriting();
    document.endWriting(null);
    expect([document.isUnsaved, document.version, document.isWriting]).toEqual([true, 1, false]);
  });

  it("follows the file, and keeps unsaved changes of other places", () => {
    const document = documentOf();
    typeText(document, "'a'", "'mine'");
    apply(document, document.onDiskChanged(TEXT.replace("'b'", "'theirs'"), 2));
    expect(readText(document)).toBe("<robot>\n  <link name='mine'/>\n  <link name='theirs'/>\n</robot>\n");
    expect([document.isUnsaved, document.conflict, document.version]).toEqual([true, null, 2]);
    typeText(document, "'mine'", "'a'");
    expect(document.isUnsaved).toBe(false);
  });

  it.each([
    ["mine", (document: SourceDocument) => (document.keepMine(), null), "'mine'", true],
    ["that of the disk", (document: SourceDocument) => document.takeDisk(), "'theirs'", false],
  ])("with changes of the same place waits for the user, who chooses %s", (_, settleConflict, name, isUnsaved) => {
    const document = documentOf();
    typeText(document, "'a'", "'mine'");
    const diskText = TEXT.replace("'a'", "'theirs'");
    expect(document.onDiskChanged(diskText, 2)).toBeNull();
    expect(document.conflict?.version).toBe(2);
    expect(readText(document)).toContain("'mine'");
    apply(document, settleConflict(document));
    expect(readText(document)).toBe(TEXT.replace("'a'", name));
    expect([document.isUnsaved, document.conflict, document.savedText.toString()]).toEqual([isUnsaved, null, diskText]);
  });

  it("has no conflict with a file that has the same change", () => {
    const document = documentOf();
    typeText(document, "'a'", "'c'");
    expect(document.onDiskChanged(TEXT.replace("'a'", "'c'"), 2)).toBeNull();
    expect([document.isUnsaved, document.conflict]).toEqual([false, null]);
  });

  it("finds places of the file in the edited text", () => {
    const document = documentOf();
    typeText(document, "<robot>\n", "<robot>\n\n\n");
    const position = TEXT.indexOf("  <link name='b'");
    expect([document.currentLineOf(3), document.describedLineOf(position + 2)]).toEqual([position + 2, 3]);
  });

  it("finds places of the text that the scene shows, which may be older or newer than the file", () => {
    const document = documentOf();
    typeText(document, "<robot>\n", "<robot>\n\n\n");
    document.recordSent(1);
    document.recordShown(1, true);
    expect(document.describedLineOf(document.currentLineOf(5))).toBe(5);
    typeText(document, "<robot>\n", "<robot>\n\n");
    document.recordSent(2);
    document.recordShown(2, false); // it has errors
    expect(document.state.doc.lineAt(document.currentLineOf(5)).number).toBe(6);
  });

  it("takes over an edit of the robot beside what was typed since, and not in the same place", () => {
    const document = documentOf();
    typeText(document, "'a'", "'c'");
    document.recordSent(1);
    typeText(document, "'c'", "'d'");
    apply(document, document.onRobotEdited(TEXT.replace("'a'", "'c'").replace("'b'", "'moved'"), 1));
    expect(readText(document)).toBe("<robot>\n  <link name='d'/>\n  <link name='moved'/>\n</robot>\n");
    expect(document.isUnsaved).toBe(true);
    expect(document.onRobotEdited(TEXT.replace("'a'", "'e'"), 1)).toBeNull();
  });
});

it("the smallest change replaces one range", () => {
  const [textBefore, textAfter] = [toText("one two three"), toText("one 2 three")];
  const parts: unknown[] = [];
  findSmallestChange(textBefore, textAfter).iterChanges((start, end, _a, _b, text) => parts.push([start, end, text.toString()]));
  expect(parts).toEqual([[4, 7, "2"]]);
  expect(findSmallestChange(textBefore, textBefore).empty).toBe(true);
  expect(findSmallestChange(toText("aa"), toText("aaa")).apply(toText("aa")).toString()).toBe("aaa");
});

it("paths come from URIs of files only", () => {
  expect(pathOf("file:///ws/%E4%B8%AD%20b.urdf")).toBe("/ws/中 b.urdf");
  expect(pathOf("file:///C:/ws/a.urdf")).toBe("C:/ws/a.urdf");
  expect(pathOf("linkwright-expansion:/ws/a.urdf")).toBeNull();
});

it("languages and indentation follow the file", () => {
  expect(["a.urdf.xacro", "b.RVIZ", "c.launch.py", "CMakeLists.txt"].map(languageOf)).toEqual(["xml", "yaml", "python", "plaintext"]);
  expect([detectIndentation("a:\n    b: 1\n"), detectIndentation("<a>\n\t<b/>"), detectIndentation("a")]).toEqual(["    ", "\t", "  "]);
});

it("positions beyond a line or text are its end", () => {
  const text = toText("ab\nc");
  expect([offsetOf(text, { line: 0, character: 9 }), offsetOf(text, { line: 1, character: 1 }), offsetOf(text, { line: 7, character: 0 })]).toEqual([2, 4, 4]);
});

it("the text of a range counts in UTF-16", () => {
  const text = toText("x = 1\n名😀 = name");
  expect(textOfRange(text, { start: { line: 1, character: 6 }, end: { line: 1, character: 10 } })).toBe("name");
});

it("a message with a text has at most a megabyte", () => {
  expect([isWithinMessageSize("a".repeat(900_000)), isWithinMessageSize("中".repeat(300_000)), isWithinMessageSize("中".repeat(400_000)), isWithinMessageSize('"'.repeat(600_000))]).toEqual([true, true, false, false]);
});

it("semantic tokens are relative to the token before", () => {
  const legend = { tokenTypes: ["macro", "variable"], tokenModifiers: ["definition"] };
  const ranges = decodeTokens(toText("one two\n  three"), [0, 0, 3, 0, 1, 0, 4, 3, 1, 0, 1, 2, 5, 0, 0], legend);
  expect(ranges).toEqual([
    { from: 0, to: 3, names: ["macro", "definition"] },
    { from: 4, to: 7, names: ["variable"] },
    { from: 10, to: 15, names: ["macro"] },
  ]);
});

it("colors are written as the browser's field has them, and read back", () => {
  expect(toHex({ red: 0.2, green: 0.6, blue: 1, alpha: 0.5 })).toBe("#3399ff");
  expect(parseHex("#3399ff")).toEqual({ red: 0.2, green: 0.6, blue: 1, alpha: 1 });
});
