import { Euler, Quaternion } from "three";
import { beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import type { EditablePart, PageMessage } from "../src/protocol";
import { EditingState } from "../src/state/editing/editing";
import { findNearestRpy, quaternionOf } from "../src/state/editing/rotation";
import { openBrowserStorage } from "../src/storage";

let sentMessages: PageMessage[];
let connection: Connection;
let editing: EditingState;
const LINK = { display: "d", link: "arm" };

function createPart(fields: Partial<EditablePart> = {}): EditablePart {
  return { part: "joint", name: "shoulder", index: 0, title: "", xyz: [0, 0, 1], rpy: [0, 0, 0], written: "", file: "/r.urdf", line: 3, ...fields };
}

function receiveParts(...parts: EditablePart[]): void {
  connection.message.emit({ type: "editable_parts", ...LINK, refusal_reason: "", parts });
}

function listSentTypes(): string[] {
  return sentMessages.map((message) => message.type);
}

beforeEach(() => {
  vi.useFakeTimers();
  sentMessages = [];
  connection = new Connection("ws://localhost/ws");
  vi.spyOn(connection, "send").mockImplementation((message) => void sentMessages.push(message));
  editing = new EditingState(connection, openBrowserStorage());
});

describe("rotations", () => {
  it("match those of URDF", () => {
    const [r, p, y] = [0.3, -1.1, 2.2];
    const quaternion = new Quaternion().setFromEuler(new Euler(r, p, y, "ZYX"));
    quaternionOf([r, p, y]).forEach((value, i) => expect(value).toBeCloseTo(quaternion.toArray()[i] ?? NaN, 12));
  });

  it.each([[[0.3, -1.1, 2.2]], [[3.1, 0.2, -3.1]], [[0.3, 2.5, 1]], [[0, 0, 0]]])("of %j keep their angles", (rpy) => {
    findNearestRpy(quaternionOf(rpy), rpy).forEach((angle, i) => expect(angle).toBeCloseTo(rpy[i] ?? NaN, 9));
  });

  it.each([Math.PI / 2, -Math.PI / 2])("keep roll at gimbal lock, %d", (pitch) => {
    const rotation = quaternionOf([0.5, pitch, 0.2]);
    const rpy = findNearestRpy(rotation, [0.4, 0, 0]);
    expect(rpy[0]).toBe(0.4);
    const quaternion = quaternionOf(rpy);
    expect(Math.abs(quaternion.reduce((sum, value, i) => sum + value * (rotation[i] ?? 0), 0))).toBeCloseTo(1, 9);
  });

  it("continue over full turns", () => {
    expect(findNearestRpy(quaternionOf([0, 0, 3.2]), [0, 0, 3.1])[2]).toBeCloseTo(3.2, 9);
  });
});

describe("editing", () => {
  it("requests the parts of a link only while an editor is open", () => {
    editing.setLink(LINK);
    expect(sentMessages).toEqual([]);
    const release = editing.activate();
    expect(sentMessages).toEqual([{ type: "request_editable_parts", ...LINK }]);
    release();
    editing.setLink({ ...LINK, link: "hand" });
    expect(sentMessages).toHaveLength(1);
  });

  it("requests a preview when dragging pauses, and only for changed values", () => {
    editing.setLink(LINK);
    editing.activate();
    receiveParts(createPart());
    editing.setDraft({ xyz: [0, 0, 1.1], rpy: [0, 0, 0] });
    editing.setDraft({ xyz: [0, 0, 1.2], rpy: [0, 0, 0] });
    expect(listSentTypes()).toEqual(["request_editable_parts"]);
    vi.runAllTimers();
    expect(sentMessages.at(-1)).toMatchObject({ type: "preview_edit", part: "joint", name: "shoulder", xyz: [0, 0, 1.2], rpy: null, together: false });
  });

  it("ignores the preview of an older request, and writes the one that is shown", () => {
    editing.setLink(LINK);
    editing.activate();
    receiveParts(createPart());
    editing.setDraft({ xyz: [0, 0, 1.1], rpy: [0, 0, 0] });
    vi.runAllTimers();
    const { number } = sentMessages.at(-1) as { number: number };
    const files = [{ file: "/r.urdf", diff: ["+x"] }];
    connection.message.emit({ type: "edit_preview", number: number - 1, files, also: [], refusal: null });
    expect(editing.preview).toBeNull();
    editing.apply();
    expect(listSentTypes()).not.toContain("apply_edit");
    connection.message.emit({ type: "edit_preview", number, files, also: [], refusal: null });
    editing.apply();
    expect(sentMessages.at(-1)).toEqual({ type: "apply_edit", number });
  });

  it("shows the requested robot until the new one arrives", () => {
    editing.setLink(LINK);
    editing.activate();
    receiveParts(createPart());
    editing.setDraft({ xyz: [0, 0, 1.1], rpy: [0, 0, 0] });
    connection.message.emit({ type: "edit_written", files: ["/r.urdf"], refusal: null, is_saved: true });
    expect(editing.draft).not.toBeNull();
    expect(editing.isDraftOpen).toBe(false);
    connection.message.emit({ type: "robot_scene", display: "d", revision: 2, name: "r", links: [], joints: [] });
    expect(editing.draft).toBeNull();
    expect(editing.writtenFiles).toEqual(["/r.urdf"]);
  });

  it("keeps a draft when other parts of the robot change, and drops it when its own values do", () => {
    editing.setLink(LINK);
    editing.activate();
    receiveParts(createPart());
    editing.setDraft({ xyz: [0, 0, 1.1], rpy: [0, 0, 0] });
    receiveParts(createPart({ line: 4 }));
    expect(editing.draft?.xyz).toEqual([0, 0, 1.1]);
    receiveParts(createPart({ xyz: [0, 0, 2] }));
    expect(editing.draft).toBeNull();
  });

  it("keeps a draft whose writing failed", () => {
    editing.setLink(LINK);
    editing.activate();
    receiveParts(createPart());
    editing.setDraft({ xyz: [0, 0, 1.1], rpy: [0, 0, 0] });
    const refusal = { code: "EDIT107", severity: "error" as const, message: "changed", file: null, line: null, column: null, end_line: null, end_column: null, excerpt: "", notes: [], hints: [] };
    connection.message.emit({ type: "edit_written", files: [], refusal, is_saved: false });
    expect(editing.isDraftOpen).toBe(true);
    expect(editing.refusal).toBe(refusal);
  });

  it("moves nothing if writing is not allowed", () => {
    editing.setLink(LINK);
    editing.activate();
    connection.message.emit({ type: "editable_parts", ...LINK, refusal_reason: "elsewhere", parts: [createPart()] });
    editing.setDraft({ xyz: [0, 0, 1.1], rpy: [0, 0, 0] });
    expect(editing.draft).toBeNull();
  });
});
