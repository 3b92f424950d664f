import { StateEffect, StateField, type EditorState, type Extension, type Range } from "@codemirror/state";
import { Decoration, EditorView, type DecorationSet } from "@codemirror/view";
import type { Highlight } from "../description/source-view";
import type { SourceDocument } from "./source-document";

const setMarks = StateEffect.define<DecorationSet>();
const LINE_DECORATIONS = { focus: Decoration.line({ class: "cm-focus-line" }), problem: Decoration.line({ class: "cm-problem-line" }) };

/** The marked lines, which move with the text. */
const marks = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update: (decorations, transaction) => {
    const effect = transaction.effects.find((candidate) => candidate.is(setMarks));
    return effect ? effect.value : decorations.map(transaction.changes);
  },
  provide: (field) => EditorView.decorations.from(field),
});

export const markedLines: Extension = marks;

/** Returns the effect that marks lines, given as lines of the text that the shown description was read from. */
export function createMarkEffect(document: SourceDocument, highlights: readonly Highlight[]): StateEffect<DecorationSet> {
  const ranges: Range<Decoration>[] = [];
  for (const { firstLine, lastLine, kind } of highlights) {
    const [firstNumber, lastNumber] = [firstLine, lastLine].map((line) => document.state.doc.lineAt(document.currentLineOf(line)).number);
    for (let line = firstNumber ?? 1; line <= (lastNumber ?? 0); line += 1) ranges.push(LINE_DECORATIONS[kind].range(document.state.doc.line(line).from));
  }
  return setMarks.of(Decoration.set(ranges, true));
}

/** Returns the marked lines, each with the kind of its mark, for tests. */
export function inspectMarks(state: EditorState): { line: number; look: string }[] {
  const lines: { line: number; look: string }[] = [];
  state.field(marks, false)?.between(0, state.doc.length, (from, _, { spec }) => {
    const kind = (spec as { class: string }).class === "cm-focus-line" ? "focus" : "problem";
    lines.push({ line: state.doc.lineAt(from).number, look: kind });
  });
  return lines;
}
