import { Group, Raycaster, Vector3 } from "three";
import { beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import type { PageMessage } from "../src/protocol";
import { Placer } from "../src/scene/modeling/placer";
import type { Stage } from "../src/scene/stage";
import type { ToolEvent } from "../src/scene/tools/tool";
import { Modeling } from "../src/state/modeling/modeling";
import { openBrowserStorage } from "../src/storage";

let sentMessages: PageMessage[];
let modeling: Modeling;
let placer: Placer;

/** A canvas seen from above, with one meter per pixel. */
function sendPointer(type: ToolEvent["type"], x: number, y: number, part: Partial<ToolEvent> = {}): boolean {
  const button = type === "move" ? null : "left";
  const defaults = { dx: 0, dy: 0, wheel: 0, isLeftDown: type !== "up", isMiddleDown: false, isRightDown: false, isShiftDown: false, isCtrlDown: false, isAltDown: false, isClick: false };
  return placer.onPointer({ type, x, y, button, ...defaults, ...part });
}

beforeEach(() => {
  sentMessages = [];
  const connection = new Connection("ws://localhost/ws");
  vi.spyOn(connection, "send").mockImplementation((message) => void sentMessages.push(message));
  modeling = new Modeling(connection, openBrowserStorage());
  const rayAt = (x: number, y: number): Raycaster => new Raycaster(new Vector3(x, y, 5), new Vector3(0, 0, -1));
  const stage = { overlays: new Group(), world: null, picker: { rayAt }, loop: { invalidate: () => undefined } };
  placer = new Placer(stage as unknown as Stage, modeling);
});

describe("placing entities in the world", () => {
  it("takes a click, snapped to the grid unless Ctrl is held; Shift continues placing", () => {
    modeling.startPlacing({ kind: "sphere", address: "" });
    sendPointer("down", 1.04, 2);
    sendPointer("up", 1.04, 2, { isClick: true, isShiftDown: true });
    sendPointer("up", 1.04, 2, { isClick: true, isCtrlDown: true });
    expect(sentMessages).toEqual([
      { type: "add_entity", shape: "sphere", address: "", pose: [1, 2, 0.25, 0, 0, 0], size: [0.25] },
      { type: "add_entity", shape: "sphere", address: "", pose: [1.04, 2, 0.25, 0, 0, 0], size: [0.25] },
    ]);
    expect(modeling.placing).toBeNull();
  });

  it("leaves dragging to the camera", () => {
    modeling.startPlacing({ kind: "box", address: "" });
    expect(sendPointer("down", 0, 0)).toBe(false);
    expect(sendPointer("move", 3, 0)).toBe(false);
    expect(sendPointer("up", 3, 0)).toBe(false);
    expect(sentMessages).toEqual([]);
  });

  it("draws walls from point to point, one after another", () => {
    modeling.startPlacing({ kind: "wall", address: "" });
    expect(sendPointer("down", 0, 0)).toBe(true);
    expect(sendPointer("move", 4, 0)).toBe(true);
    sendPointer("up", 4, 0);
    expect(sentMessages).toEqual([{ type: "add_entity", shape: "wall", address: "", pose: [2, 0, 0.5, 0, 0, 0], size: [4, 0.1, 1] }]);
    sendPointer("down", 4, 0);
    sendPointer("up", 4, 0, { isClick: true });
    sendPointer("down", 4, 3);
    sendPointer("up", 4, 3, { isClick: true });
    expect(sentMessages.at(-1)).toMatchObject({ pose: [4, 1.5, 0.5, 0, 0, Math.PI / 2], size: [3, 0.1, 1] });
    expect(modeling.placing?.kind).toBe("wall");
  });

  it("places an entity dragged from the bar", () => {
    placer.drop({ kind: "model", address: "model://chair" }, 2, 3);
    expect(sentMessages).toEqual([{ type: "add_entity", shape: "model", address: "model://chair", pose: [2, 3, 0, 0, 0, 0], size: [] }]);
  });
});
