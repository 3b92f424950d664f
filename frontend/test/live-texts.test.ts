import { EditorState } from "@codemirror/state";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { Connection } from "../src/connection/connection";
import { LiveTexts } from "../src/panels/source-editor/live-texts";
import { SourceDocument } from "../src/panels/source-editor/source-document";
import type { UnsavedTextShown } from "../src/protocol";

const PATH = "/ws/a.urdf";

beforeEach(() => {
  vi.useFakeTimers();
});
afterEach(() => {
  vi.useRealTimers();
});

function openDocument() {
  const document = new SourceDocument(PATH, `file://${PATH}`, 1, EditorState.create({ doc: "<robot/>" }));
  const sentTexts: (string | null)[] = [];
  let answer: (message: UnsavedTextShown) => void = () => undefined;
  const connection = {
    send: ({ text }: { text: string | null }) => sentTexts.push(text),
    on: (type: string, listener: typeof answer) => {
      if (type === "unsaved_text_shown") answer = listener;
    },
  };
  const documents = { open: [document], isShownInScene: () => true, applyEdit: () => undefined };
  const liveTexts = new LiveTexts(connection as unknown as Connection, documents, () => undefined);
  return {
    liveTexts,
    sentTexts,
    type: (insert: string) => {
      document.record(document.state.update({ changes: { from: document.state.doc.length, insert } }));
      liveTexts.scheduleSending();
    },
    save: () => {
      document.beginWriting();
      document.endWriting(document.version + 1);
      liveTexts.scheduleSending();
    },
    answer: (number: number) => answer({ type: "unsaved_text_shown", number, path: PATH, outcome: "shown" }),
  };
}

it("a saved text is removed from the server, also if the answer about it arrives between saving and the next request", () => {
  const { liveTexts, sentTexts, type, save, answer } = openDocument();
  type("\n");
  vi.runAllTimers();
  expect(sentTexts).toEqual(["<robot/>\n"]);
  save();
  answer(1);
  vi.runAllTimers();
  expect(sentTexts).toEqual(["<robot/>\n", null]);
  expect(liveTexts.outcome).toBe("shown");
  answer(2);
  expect(liveTexts.outcome).toBeNull();
});

it("a text is removed from the server once, and sent again after a new change", () => {
  const { liveTexts, sentTexts, type, save, answer } = openDocument();
  type("\n");
  vi.runAllTimers();
  save();
  vi.runAllTimers();
  liveTexts.scheduleSending();
  vi.runAllTimers();
  type("\n");
  vi.runAllTimers();
  expect(sentTexts).toEqual(["<robot/>\n", null, "<robot/>\n\n"]);
  answer(2);
  answer(3);
  expect(liveTexts.outcome).toBe("shown");
});
